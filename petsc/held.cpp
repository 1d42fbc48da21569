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
        is_held_(elements_.size(), 0),
        left_of_(part.mesh.vertex_count(), 0) {
    for (VertexId v = 0; v < part.was_shared.size(); ++v)
      if (part.was_shared[v] != 0) front_.push_back(v);
  }

  std::vector<std::uint8_t> spread(std::uint8_t layers) {
    for (const VertexId v : front_) left_of_[v] = layers;
    while (!front_.empty()) add_layer(layers);
    return std::move(is_held_);
  }

 private:
  /// Adds the elements around the front. Their corners are the next one, where there are layers
  /// left: all of them around blocked edges.
  void add_layer(std::uint8_t layers) {
    struct Reached {
      VertexId vertex;
      std::uint8_t left;
    };
    std::vector<Reached> reached;
    for (const VertexId v : front_)
      for (const std::uint32_t e : around_.of(v)) {
        if (std::exchange(is_held_[e], 1) != 0) continue;
        std::uint8_t most = 1;
        for (const VertexId w : elements_[e]) most = std::max(most, left_of_[w]);
        const std::uint8_t left =
            has_blocked_edge<Dim>(part_, e) ? layers : static_cast<std::uint8_t>(most - 1);
        for (const VertexId w : elements_[e]) reached.push_back({w, left});
      }
    for (const VertexId v : front_) left_of_[v] = 0;
    front_.clear();
    for (const auto& [vertex, left] : reached) {
      if (left <= left_of_[vertex]) continue;
      if (left_of_[vertex] == 0) front_.push_back(vertex);
      left_of_[vertex] = left;
    }
  }

  const Part& part_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  ElementsAround<Dim> around_;
  std::vector<std::uint8_t> is_held_;  // [element]
  std::vector<std::uint8_t> left_of_;  // [vertex], layers beyond it; 0 but in front
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
std::vector<std::uint8_t> held_elements(const Part& part, std::uint8_t layers) {
  if (part.element_count() == 0) return {};
  return Zone<Dim>(part).spread(layers);
}

template bool has_blocked_edge<2>(const Part&, std::uint32_t);
template bool has_blocked_edge<3>(const Part&, std::uint32_t);
template EdgesAtInterfaces edges_at_interfaces<2>(const Part&, const Interfaces&);
template EdgesAtInterfaces edges_at_interfaces<3>(const Part&, const Interfaces&);
template std::vector<std::uint8_t> held_elements<2>(const Part&, std::uint8_t);
template std::vector<std::uint8_t> held_elements<3>(const Part&, std::uint8_t);

}  // namespace ductile::petsc
