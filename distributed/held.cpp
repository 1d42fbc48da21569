#include "distributed/held.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "distributed/listed.hpp"

namespace ductile::distributed {

using meshadapt::Vector;

namespace {

/// Length of an edge in the target metric.
template <int Dim>
double wanted_length(const Part& part, VertexId a, VertexId b) {
  const Vector<Dim> edge =
      meshadapt::position_in<Dim>(part.mesh, b) - meshadapt::position_in<Dim>(part.mesh, a);
  const auto length_at = [&](VertexId v) {
    return std::sqrt(meshadapt::squared_length(wanted_at<Dim>(part, v), edge));
  };
  return meshadapt::mean_length(length_at(a), length_at(b));
}

/// Is any edge of an element blocked?
template <int Dim>
bool has_blocked_edge(const Part& part, std::uint32_t element) {
  const auto& corners = meshadapt::elements_in<Dim>(part.mesh).vertices[element];
  for (std::size_t k = 0; k < meshadapt::Simplex<Dim>::edges; ++k) {
    const auto [a, b] = meshadapt::ends_of_edge<Dim>(corners, k);
    if (is_blocked(wanted_length<Dim>(part, a, b))) return true;
  }
  return false;
}

/// A region that grows in layers from held vertices.
template <int Dim>
class Zone {
 public:
  Zone(const runtime::Executor& executor, const Part& part)
      : part_(part),
        elements_(meshadapt::elements_in<Dim>(part.mesh).vertices),
        around_(elements_around<Dim>(executor, part.mesh)),
        is_held_(elements_.size(), 0),
        is_reached_(part.mesh.vertex_count(), 0) {
    for (VertexId v = 0; v < part.is_held.size(); ++v)
      if (part.is_held[v] != 0) reach(v);
  }

  std::vector<std::uint8_t> spread(int layers) {
    for (std::size_t next = 0; next < reached_.size();)  // the list grows meanwhile
      add_around(reached_[next++], Which::blocked);
    std::size_t first = 0;  // first vertex not yet surrounded by the layer
    for (int layer = 0; layer < layers; ++layer)
      for (const std::size_t end = reached_.size(); first < end; ++first)
        add_around(reached_[first], Which::all);
    return std::move(is_held_);
  }

 private:
  enum class Which : std::uint8_t { blocked, all };

  void reach(VertexId v) {
    if (std::exchange(is_reached_[v], 1) == 0) reached_.push_back(v);
  }

  void add_around(VertexId v, Which which) {
    for (const std::uint32_t e : around_.elements_of(v)) {
      if (is_held_[e] != 0) continue;
      if (which == Which::blocked && !has_blocked_edge<Dim>(part_, e)) continue;
      is_held_[e] = 1;
      for (const VertexId w : elements_[e]) reach(w);
    }
  }

  const Part& part_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  meshadapt::VertexElements around_;
  std::vector<std::uint8_t> is_held_;     // [element]
  std::vector<std::uint8_t> is_reached_;  // [vertex]
  std::vector<VertexId> reached_;
};

template <int Dim>
EdgesAtInterfaces edges_at_interfaces(const Part& part, const Interfaces& interfaces) {
  EdgesAtInterfaces edges;
  std::vector<std::uint8_t> is_shared(part.mesh.vertex_count(), 0);
  edges.is_at_blocked.assign(is_shared.size(), 0);
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
  for (const auto& [a, b] : found) {
    if (!is_blocked(wanted_length<Dim>(part, a, b))) continue;
    ++edges.blocked;
    for (const VertexId end : {a, b})
      if (is_shared[end] != 0) edges.is_at_blocked[end] = 1;
  }
  return edges;
}

}  // namespace

EdgesAtInterfaces edges_at_interfaces(const Part& part, const Interfaces& interfaces) {
  return part.mesh.dimension == 2 ? edges_at_interfaces<2>(part, interfaces)
                                  : edges_at_interfaces<3>(part, interfaces);
}

std::vector<std::uint8_t> held_elements(const runtime::Executor& executor, const Part& part,
                                        int layers) {
  if (part.element_count() == 0) return {};
  return part.mesh.dimension == 2 ? Zone<2>(executor, part).spread(layers)
                                  : Zone<3>(executor, part).spread(layers);
}

}  // namespace ductile::distributed
