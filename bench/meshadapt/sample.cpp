#include "sample.hpp"

#include <bit>
#include <chrono>
#include <utility>

#include "ductile/meshadapt/statistics.hpp"

namespace ductile::bench {

using meshadapt::AdaptedMesh;
using meshadapt::AdaptReport;
using meshadapt::KernelReport;
using runtime::Executor;

namespace {

class Hash {
 public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3U; }
  void add(const std::vector<double>& values) {
    add(values.size());
    for (const double value : values) add(std::bit_cast<std::uint64_t>(value));
  }
  template <class Integer>
  void add(const std::vector<Integer>& values) {
    add(values.size());
    for (const Integer value : values) add(static_cast<std::uint64_t>(value));
  }
  template <int Corners>
  void add(const meshadapt::Cells<Corners>& cells) {
    add(cells.reference);
    for (const auto& corners : cells.vertices)
      for (const std::uint32_t corner : corners) add(corner);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

PhaseSeconds phases_of(const KernelReport& kernel) {
  PhaseSeconds phases{0,
                      kernel.conflict_seconds,
                      kernel.plan_seconds,
                      kernel.apply_seconds,
                      kernel.commit_seconds,
                      kernel.wake_seconds};
  phases[0] = kernel.seconds;
  for (std::size_t i = 1; i < phases.size(); ++i) phases[0] -= phases[i];
  return phases;
}

/// Adds the seconds of one call.
void add(Sample& sample, const AdaptReport& report) {
  PartSeconds parts{};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    const KernelReport& kernel = report.*meshadapt::kernels[k].report;
    parts[k] = kernel.seconds;
    const PhaseSeconds phases = phases_of(kernel);
    for (std::size_t i = 0; i < phases.size(); ++i) sample.phase_seconds[k][i] += phases[i];
  }
  parts[kernel_count] = report.setup_seconds;
  parts[kernel_count + 1] = report.renumber_seconds;
  parts[kernel_count + 3] = report.total_seconds;
  double& other = parts[kernel_count + 2];
  other = report.total_seconds;
  for (std::size_t i = 0; i < kernel_count + 2; ++i) other -= parts[i];
  for (std::size_t i = 0; i < parts.size(); ++i) sample.part_seconds[i] += parts[i];
}

}  // namespace

std::uint64_t fingerprint(const AdaptedMesh& result) {
  Hash hash;
  const meshadapt::AnyMesh& mesh = result.mesh;
  hash.add(mesh.coordinates);
  hash.add(mesh.vertex_reference);
  hash.add(mesh.edges);
  hash.add(mesh.triangles);
  hash.add(mesh.tetrahedra);
  hash.add(mesh.corners);
  hash.add(mesh.ridges);
  hash.add(result.metric.values);
  return hash.value();
}

Sampler::Sampler(const AdaptCase& adapt_case)
    : case_(adapt_case), start_metric_(case_.metric_on(judges_, case_.start)) {}

meshadapt::AdaptOptions Sampler::options(Mode mode) const {
  return {.by_colours = mode == Mode::colours,
          .make = {.hausdorff_tolerance = case_.hausdorff_tolerance}};
}

double Sampler::first_call_alone() const {
  return adapt(Executor({.threads = 1}), case_.start, start_metric_, options(Mode::tiles))
      .report.total_seconds;
}

/// Times the calls of adapt(); the metric of the next call is evaluated while the clock is stopped.
Sample Sampler::timed(const Executor& executor, Mode mode, AdaptedMesh& result) const {
  Sample sample;
  meshadapt::AnyMesh last;
  meshadapt::AnyField metric;
  for (int call = 0; call < case_.calls; ++call) {
    const bool first = call == 0;
    if (!first) last = std::move(result.mesh);
    if (!first) metric = case_.metric_on(judges_, last);
    const double processor = processor_seconds();
    const auto clock = std::chrono::steady_clock::now();
    result =
        adapt(executor, first ? case_.start : last, first ? start_metric_ : metric, options(mode));
    sample.wall_seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    sample.processor_seconds += processor_seconds() - processor;
    add(sample, result.report);
  }
  return sample;
}

MeshFigures Sampler::judge(const AdaptedMesh& result) const {
  const auto metric = case_.calls == 1 ? result.metric : case_.metric_on(judges_, result.mesh);
  const auto statistics = measure(judges_, result.mesh, &metric);
  return {statistics.share_in_range(), statistics.quality.mean, statistics.quality.min,
          is_sound(judges_, case_, result.mesh)};
}

Sample Sampler::take(const RunSettings& settings, int repetition) {
  const Executor executor({.threads = settings.threads});
  AdaptedMesh result;
  const CoreDistance before = core_distance(settings.threads);
  reset_peak_memory();
  Sample sample = timed(executor, settings.mode, result);
  sample.peak_memory = peak_memory();
  sample.before = before;
  sample.after = core_distance(settings.threads);
  sample.case_name = case_.name;
  sample.settings = settings;
  sample.repetition = repetition;
  sample.start_elements = element_count(case_.start);
  sample.elements = element_count(result.mesh);
  sample.fingerprint = fingerprint(result);
  sample.instructions = result.report.instructions;
  const auto known = known_.find(sample.fingerprint);
  sample.figures = known != known_.end() ? known->second : judge(result);
  known_[sample.fingerprint] = sample.figures;
  return sample;
}

}  // namespace ductile::bench
