#include "adapt/processor_level.hpp"

namespace ductile::meshadapt {

std::string_view name_of(ProcessorLevel level) {
  switch (level) {
    case ProcessorLevel::v3:
      return "x86-64-v3";
    case ProcessorLevel::v4:
      return "x86-64-v4";
    case ProcessorLevel::as_built:
      break;
  }
  return "as built";
}

// Asks for the instructions that DuctileLevels.cmake has the compiler use.
std::vector<ProcessorLevel> usable_levels() {
  std::vector<ProcessorLevel> levels;
#if defined(DUCTILE_LEVEL_v3) || defined(DUCTILE_LEVEL_v4)
  const bool is_v3 = __builtin_cpu_supports("popcnt") && __builtin_cpu_supports("bmi") &&
                     __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx2");
#endif
#ifdef DUCTILE_LEVEL_v4
  if (is_v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    levels.push_back(ProcessorLevel::v4);
#endif
#ifdef DUCTILE_LEVEL_v3
  if (is_v3) levels.push_back(ProcessorLevel::v3);
#endif
  levels.push_back(ProcessorLevel::as_built);
  return levels;
}

AdaptedMesh adapt_at([[maybe_unused]] ProcessorLevel level, const runtime::Executor& executor,
                     const AnyMesh& mesh, MetricSource& source, const AdaptOptions& options) {
#ifdef DUCTILE_LEVEL_v4
  if (level == ProcessorLevel::v4)
    return adapt_at_level<ProcessorLevel::v4>(executor, mesh, source, options);
#endif
#ifdef DUCTILE_LEVEL_v3
  if (level == ProcessorLevel::v3)
    return adapt_at_level<ProcessorLevel::v3>(executor, mesh, source, options);
#endif
  return adapt_at_level<ProcessorLevel::as_built>(executor, mesh, source, options);
}

}  // namespace ductile::meshadapt
