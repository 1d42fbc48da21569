/// @file
/// Sample: one measured adaptation: its time by kernel and phase, its memory, the resulting mesh,
/// and the distance between cores before and after.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cases/adapt_case.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "machine.hpp"

namespace ductile::bench {

/// How kernels run: AdaptOptions::by_colours.
enum class Mode : std::uint8_t { tiles, colours };

struct RunSettings {
  int threads = 1;
  Mode mode = Mode::tiles;
};

inline const char* name_of(Mode mode) { return mode == Mode::tiles ? "tiles" : "colours"; }

/// Quality of a mesh in its metric: after one call the start mesh's, interpolated; after several
/// the formula's.
struct MeshFigures {
  double share_in_range = 0, mean_quality = 0, least_quality = 0;
  bool valid = false;  ///< the mesh is valid and covers the domain
};

/// Parts of the time of adapt(), in the order of all tables: the kernels are the first ones.
constexpr std::size_t kernel_count = meshadapt::kernels.size();
constexpr auto part_names = [] {
  std::array<const char*, kernel_count + 4> names{};
  for (std::size_t k = 0; k < kernel_count; ++k) names[k] = meshadapt::kernels[k].name;
  std::size_t part = kernel_count;
  for (const char* name : {"setup", "renumber", "other", "total"}) names[part++] = name;
  return names;
}();
using PartSeconds = std::array<double, part_names.size()>;

/// Parts of a kernel's time.
constexpr std::array<const char*, 6> phase_names{"looking", "conflict", "plan",
                                                 "apply",   "commit",   "wake"};
using PhaseSeconds = std::array<double, phase_names.size()>;

struct Sample {
  std::string case_name;
  RunSettings settings;
  int repetition = 0;
  double wall_seconds = 0, processor_seconds = 0;  ///< all calls of adapt() together
  PartSeconds part_seconds{};
  std::array<PhaseSeconds, kernel_count> phase_seconds{};
  std::size_t start_elements = 0, elements = 0;
  std::size_t peak_memory = 0;    ///< bytes, with the case in memory
  std::uint64_t fingerprint = 0;  ///< hash of all bytes of the result
  std::string_view instructions;  ///< see AdaptReport
  MeshFigures figures;
  CoreDistance before, after;

  std::string placement() const { return placement_of(before); }
  bool steady() const { return placement_of(before) == placement_of(after); }
};

/// Adapts cases and judges the results; identical results are judged once. Thread safety: one
/// thread.
class Sampler {
 public:
  explicit Sampler(const AdaptCase& adapt_case);

  /// Times all calls of adapt() on a new executor.
  Sample take(const RunSettings& settings, int repetition);

  /// Seconds of the first call, on one thread; starts no threads.
  double first_call_alone() const;

 private:
  meshadapt::AdaptOptions options(Mode mode) const;
  Sample timed(const runtime::Executor& executor, Mode mode, meshadapt::AdaptedMesh& result) const;
  MeshFigures judge(const meshadapt::AdaptedMesh& result) const;

  const AdaptCase& case_;
  runtime::Executor judges_;  // runs what is not timed
  meshadapt::AnyField start_metric_;
  std::map<std::uint64_t, MeshFigures> known_;
};

/// A hash of everything in the mesh and the metric (FNV-1a over 64-bit words).
std::uint64_t fingerprint(const meshadapt::AdaptedMesh& result);

}  // namespace ductile::bench
