#include "held.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/meshadapt/metric.hpp"
#include "elements_around.hpp"

namespace ductile::petsc {

using meshadapt::Metric;
using meshadapt::Vector;

namespace {

/// Length of an edge by what is wanted at its ends.
template <int Dim>
double wanted_length(const Part& part, VertexId a, VertexId b) {
  const Vector<Dim> edge =
      meshadapt::position_in<Dim>(part.mesh, b) - meshadapt::position_in<Dim>(part.mesh, a);
  const auto length_at = [&](VertexId v) {
    Metric<Dim> metric;
    std::copy_n(&part.wanted.values[v * metric.m.size()], metric.m.size(), metric.m.begin());
    return std::sqrt(meshadapt::squared_length(metric, edge));
  };
  return meshadapt::mean_length(length_at(a), length_at(b));
}

/// What spreads from vertices that were shared, layer by layer.
template <int Dim>
class Zone {
 public:
  explicit Zone(const Part& part)
      : part_(part),
        elements_(meshadapt::elements_in<Dim>(part.mesh).vertices),
        around_(part.mesh),
        is_held_(elements_.size(), 0) {
    for (VertexId v = 0; v < part.was_shared.size(); ++v)
      if (part.was_shared[v] != 0) front_.push_back(v);
  }

  std::vector<std::uint8_t> spread(int layers) {
    for (int left = layers; left > 0 && !front_.empty(); --left)
      if (add_layer()) left = layers + 1;
    return std::move(is_held_);
  }

 private:
  /// Adds the elements around the front, whose corners are the next one. Returns whether one of them
  /// has a blocked edge.
  bool add_layer() {
    std::vector<VertexId> next;
    bool blocked = false;
    for (const VertexId v : front_)
      for (const std::uint32_t e : around_.of(v)) {
        if (std::exchange(is_held_[e], 1) != 0) continue;
        next.insert(next.end(), elements_[e].begin(), elements_[e].end());
        blocked = blocked || has_blocked_edge<Dim>(part_, e);
      }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    front_ = std::move(next);
    return blocked;
  }

  const Part& part_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  ElementsAround<Dim> around_;
  std::vector<std::uint8_t> is_held_;  // [element]
  std::vector<VertexId> front_;
};

}  // namespace

template <int Dim>
bool has_blocked_edge(const Part& part, std::uint32_t element) {
  const auto& corners = meshadapt::elements_in<Dim>(part.mesh).vertices[element];
  for (std::size_t k = 0; k < meshadapt::Simplex<Dim>::edges; ++k) {
    const auto [a, b] = meshadapt::ends_of_edge<Dim>(corners, k);
    if (is_blocked(wanted_length<Dim>(part, a, b))) return true;
  }
  return false;
}

template <int Dim>
EdgesAtInterfaces edges_at_interfaces(const Part& part, const Interfaces& interfaces) {
  EdgesAtInterfaces edges;
  if (part.element_count() == 0) return edges;
  std::vector<std::uint8_t> is_shared(part.mesh.vertex_count(), 0);
  for (const SharedVertex& shared : interfaces.vertices) is_shared[shared.vertex] = 1;
  std::vector<std::pair<VertexId, VertexId>> found;
  for (const auto& corners : meshadapt::elements_in<Dim>(part.mesh).vertices)
    for (std::size_t k = 0; k < meshadapt::Simplex<Dim>::edges; ++k) {
      const auto [a, b] = meshadapt::ends_of_edge<Dim>(corners, k);
      if (is_shared[a] != 0 || is_shared[b] != 0) found.emplace_back(std::minmax(a, b));
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  edges.all = static_cast<std::int64_t>(found.size());
  edges.blocked = std::count_if(found.begin(), found.end(), [&](const auto& edge) {
    return is_blocked(wanted_length<Dim>(part, edge.first, edge.second));
  });
  return edges;
}

template <int Dim>
std::vector<std::uint8_t> held_elements(const Part& part, int layers) {
  if (part.element_count() == 0) return {};
  return Zone<Dim>(part).spread(layers);
}

template bool has_blocked_edge<2>(const Part&, std::uint32_t);
template bool has_blocked_edge<3>(const Part&, std::uint32_t);
template EdgesAtInterfaces edges_at_interfaces<2>(const Part&, const Interfaces&);
template EdgesAtInterfaces edges_at_interfaces<3>(const Part&, const Interfaces&);
template std::vector<std::uint8_t> held_elements<2>(const Part&, int);
template std::vector<std::uint8_t> held_elements<3>(const Part&, int);

}  // namespace ductile::petsc
