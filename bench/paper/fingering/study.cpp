#include "fingering/study.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace ductile::paper {

namespace {
/// 1 behind the front, 0 ahead; the front's place is a sum of waves with phases that look random.
double saturation_at_start(const meshadapt::Vector<2>& point) {
  constexpr double place = 0.1, thickness = 0.03, amplitude = 0.006;
  double front = place;
  for (int k = 3; k <= 16; ++k)
    front += amplitude * std::sin(2.3 * k * k + 1) * std::cos(std::numbers::pi * k * point[1]);
  return std::erfc((point[0] - front) / thickness) / 2;
}

}  // namespace

std::unique_ptr<Simulation> run_case(const runtime::Executor& executor, const RunOptions& options,
                                     const Watch& watch) {
  auto run = std::make_unique<Simulation>(
      executor, Fluids{}, meshadapt::box_mesh<2>({2, 1}, {2 * options.cells, options.cells}),
      saturation_at_start);
  const bool adapts = options.adapt_every > 0;
  AdaptGoal goal = options.goal;
  goal.ahead = options.adapt_every * options.interval;
  if (adapts) run->adapt_to_start(goal, saturation_at_start);
  watch(*run);
  const int intervals = static_cast<int>(std::lround(options.end / options.interval));
  for (int i = 0; i < intervals; ++i) {
    if (adapts && i > 0 && i % options.adapt_every == 0) run->adapt(goal);
    run->advance(options.interval);
    watch(*run);
  }
  return run;
}

Outcome compare(const runtime::Executor& executor, const Simulation& run,
                const Simulation& reference) {
  const meshadapt::AnyField field = meshadapt::scalar_field(2, run.saturation());
  std::vector<double> difference_of =
      meshadapt::interpolate_field(executor, {.mesh = run.mesh(), .field = field}, reference.mesh())
          .field.values;
  for (std::size_t v = 0; v < difference_of.size(); ++v)
    difference_of[v] = std::abs(difference_of[v] - reference.saturation()[v]);
  return {.adapted = run.adapted(),
          .triangles = run.mean_triangles(),
          .error = reference.integral(difference_of),
          .seconds = run.timings().total(),
          .solving = run.timings().solving(),
          .steps = run.steps()};
}

std::vector<std::pair<double, double>> profile(const Simulation& run, double x) {
  std::vector<std::pair<double, double>> result;
  const auto& dual = run.dual();
  for (const auto [from, to] : dual.edges) {
    const auto &a = dual.mesh.position_of[from], &b = dual.mesh.position_of[to];
    if ((a[0] < x) == (b[0] < x)) continue;
    const double t = (x - a[0]) / (b[0] - a[0]);
    const auto between = [&](double at_a, double at_b) { return (1 - t) * at_a + t * at_b; };
    result.emplace_back(between(a[1], b[1]), between(run.saturation()[from], run.saturation()[to]));
  }
  std::sort(result.begin(), result.end());
  return result;
}

Fingers fingers(const Simulation& run) {
  Fingers result{.root = 2, .tip = 0};
  for (VertexId v = 0; v < run.saturation().size(); ++v) {
    const double x = run.dual().mesh.position_of[v][0];
    if (run.saturation()[v] < 0.5)
      result.root = std::min(result.root, x);
    else
      result.tip = std::max(result.tip, x);
  }
  bool inside = false;
  for (const auto& [y, saturation] : profile(run, (result.root + result.tip) / 2)) {
    const bool finger = saturation > 0.5;
    if (finger && !inside) ++result.count;
    inside = finger;
  }
  return result;
}

Outcome uniform_for_error(const std::vector<Outcome>& uniform, double error) {
  std::vector<Outcome> nearest = uniform;
  const auto distance = [&](const Outcome& run) { return std::abs(std::log(run.error / error)); };
  std::sort(nearest.begin(), nearest.end(),
            [&](const Outcome& a, const Outcome& b) { return distance(a) < distance(b); });
  const Outcome &a = nearest[0], &b = nearest[1];
  const double share = std::log(error / a.error) / std::log(b.error / a.error);
  const auto between = [&](double at_a, double at_b) {
    return at_a * std::pow(at_b / at_a, share);
  };
  const auto seconds = [&](const Seconds& at_a, const Seconds& at_b) -> Seconds {
    return {between(at_a.wall, at_b.wall), between(at_a.processor, at_b.processor)};
  };
  return {.triangles = between(a.triangles, b.triangles),
          .error = error,
          .seconds = seconds(a.seconds, b.seconds),
          .solving = seconds(a.solving, b.solving)};
}

}  // namespace ductile::paper
