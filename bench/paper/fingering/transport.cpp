#include "fingering/transport.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::paper {

namespace {

/// The share of the largest step within bounds that is used.
constexpr double caution = 0.9;

template <class Value>
void for_each_vertex(const runtime::Executor& executor, std::vector<double>& result_of,
                     Value&& value) {
  runtime::parallel_for(executor, result_of.size(),
                        [&](std::size_t v) { result_of[v] = value(static_cast<VertexId>(v)); });
}

}  // namespace

Transport::Transport(const runtime::Executor& executor, const DualMesh& dual, const Fluids& fluids,
                     const Flow& flow)
    : executor_(executor),
      dual_(dual),
      forward_of_(dual.edges.size()),
      backward_of_(dual.edges.size()),
      correction_of_(dual.edges.size()),
      outflow_of_(dual.vertex_count(), 0),
      low_of_(dual.vertex_count()),
      may_gain_of_(dual.vertex_count()),
      may_lose_of_(dual.vertex_count()) {
  for (EdgeId e = 0; e < dual.edges.size(); ++e) {
    // Where a triangle is obtuse, diffusion along its longest edge has the wrong sign for bounds.
    const double diffusion = fluids.diffusivity * dual.stiffness_of[e];
    forward_of_[e] = std::max(flow.flux_of[e], 0.0) + std::max(diffusion, 0.0);
    backward_of_[e] = std::max(-flow.flux_of[e], 0.0) + std::max(diffusion, 0.0);
    correction_of_[e] = std::min(diffusion, 0.0) - std::abs(flow.flux_of[e]) / 2;
  }
  for (std::size_t i = 0; i < dual.outlet.size(); ++i)
    outflow_of_[dual.outlet[i]] = std::max(flow.outflow_of[i], 0.0);
}

double Transport::largest_step() const {
  return runtime::parallel_reduce(
      executor_, dual_.vertex_count(), std::numeric_limits<double>::infinity(),
      [&](std::size_t v) {
        double loss = outflow_of_[v];
        for (const EdgeId e : dual_.edges_at(static_cast<VertexId>(v)))
          loss += dual_.edges[e].from == v ? forward_of_[e] : backward_of_[e];
        return dual_.mesh.share_of[v] / loss;
      },
      [](double a, double b) { return std::min(a, b); });
}

double Transport::low_order(VertexId vertex, const std::vector<double>& old_of, double step) const {
  double gain = dual_.inflow_of[vertex] - outflow_of_[vertex] * old_of[vertex];
  for (const EdgeId e : dual_.edges_at(vertex)) {
    const auto [from, to] = dual_.edges[e];
    const double flux = forward_of_[e] * old_of[from] - backward_of_[e] * old_of[to];
    gain -= outflow_sign(dual_.edges[e], vertex) * flux;
  }
  return old_of[vertex] + step / dual_.mesh.share_of[vertex] * gain;
}

/// The shares of all corrections towards and away from a vertex that keep it within the values
/// around it.
void Transport::find_limits(VertexId vertex, const std::vector<double>& old_of, double step) {
  double low = std::min(low_of_[vertex], old_of[vertex]);
  double high = std::max(low_of_[vertex], old_of[vertex]);
  double gain = 0, loss = 0;
  for (const EdgeId e : dual_.edges_at(vertex)) {
    const auto [from, to] = dual_.edges[e];
    const VertexId other = from == vertex ? to : from;
    low = std::min({low, low_of_[other], old_of[other]});
    high = std::max({high, low_of_[other], old_of[other]});
    const double outwards = outflow_sign(dual_.edges[e], vertex) * correction(e, old_of);
    (outwards > 0 ? loss : gain) += std::abs(outwards);
  }
  const double room = dual_.mesh.share_of[vertex] / step;
  const auto share = [](double allowed, double wanted) {
    return wanted > allowed ? std::max(allowed, 0.0) / wanted : 1.0;
  };
  may_gain_of_[vertex] = share(room * (high - low_of_[vertex]), gain);
  may_lose_of_[vertex] = share(room * (low_of_[vertex] - low), loss);
}

double Transport::corrected(VertexId vertex, const std::vector<double>& old_of, double step) const {
  double gain = 0;
  for (const EdgeId e : dual_.edges_at(vertex)) {
    const auto [from, to] = dual_.edges[e];
    const double flux = correction(e, old_of);
    const double share = flux > 0 ? std::min(may_lose_of_[from], may_gain_of_[to])
                                  : std::min(may_gain_of_[from], may_lose_of_[to]);
    gain -= outflow_sign(dual_.edges[e], vertex) * share * flux;
  }
  return low_of_[vertex] + step / dual_.mesh.share_of[vertex] * gain;
}

void Transport::take_step(std::vector<double>& saturation_of, Ledger& ledger, double step) {
  for (std::size_t i = 0; i < saturation_of.size(); ++i) {
    ledger.injected += step * dual_.inflow_of[i];
    ledger.produced += step * outflow_of_[i] * saturation_of[i];
  }
  for_each_vertex(executor_, low_of_,
                  [&](VertexId v) { return low_order(v, saturation_of, step); });
  runtime::parallel_for(executor_, saturation_of.size(), [&](std::size_t v) {
    find_limits(static_cast<VertexId>(v), saturation_of, step);
  });
  std::vector<double> next_of(saturation_of.size());
  for_each_vertex(executor_, next_of,
                  [&](VertexId v) { return corrected(v, saturation_of, step); });
  saturation_of.swap(next_of);
}

int Transport::advance(std::vector<double>& saturation_of, Ledger& ledger, double interval) {
  const int steps = static_cast<int>(std::ceil(interval / (caution * largest_step())));
  for (int i = 0; i < steps; ++i) {
    std::vector<double> heun = saturation_of;
    Ledger other = ledger;
    take_step(heun, other, interval / steps);
    take_step(heun, other, interval / steps);
    for (std::size_t v = 0; v < heun.size(); ++v)
      saturation_of[v] = (saturation_of[v] + heun[v]) / 2;
    ledger.injected = (ledger.injected + other.injected) / 2;
    ledger.produced = (ledger.produced + other.produced) / 2;
  }
  return steps;
}

}  // namespace ductile::paper
