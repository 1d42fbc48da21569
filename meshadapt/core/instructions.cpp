#include "core/instructions.hpp"

namespace ductile::meshadapt {

std::string_view name_of(Instructions instructions) {
  return instructions == Instructions::avx512 ? "x86-64-v4" : "as built";
}

// The features are those of run_with_avx512().
Instructions best_instructions() {
#ifdef DUCTILE_HAS_AVX512
  if (__builtin_cpu_supports("popcnt") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx2") &&
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return Instructions::avx512;
#endif
  return Instructions::as_built;
}

}  // namespace ductile::meshadapt
