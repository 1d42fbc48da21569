#include "move/part.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>

namespace ductile::meshadapt {

namespace {

std::vector<std::uint8_t> marked(std::size_t count, const std::vector<std::uint32_t>& list) {
  std::vector<std::uint8_t> marks(count, 0);
  for (const std::uint32_t i : list) marks[i] = 1;
  return marks;
}

/// The list of required cells with so many corners of a mesh.
template <int N>
auto& required_of(auto& mesh) {
  return N == 2 ? mesh.required_edges : mesh.required_triangles;
}

/// The largest reference that none of these is.
std::int32_t other_than(const std::vector<std::int32_t>& references) {
  const std::set<std::int32_t> used(references.begin(), references.end());
  std::int32_t other = std::numeric_limits<std::int32_t>::max();
  while (used.contains(other)) --other;
  return other;
}

}  // namespace

template <int Dim>
Part<Dim>::Part(const MovingMesh<Dim>& whole, const FixedMesh<Dim>& topology,
                const std::vector<std::uint8_t>& is_chosen)
    : whole_(whole),
      topology_(topology),
      is_chosen_(is_chosen),
      held_{other_than(whole.any.edges.reference), other_than(whole.any.triangles.reference)},
      local_of_(whole.site_of.size(), none) {
  mesh_.dimension = Dim;
  mesh_.name = whole.any.name;
  for (std::size_t e = 0; e < is_chosen.size(); ++e)
    if (is_chosen[e]) elements_.push_back(static_cast<ElementId>(e));
  take_vertices();
  take_listed<2>();
  if constexpr (Dim == 3) take_listed<3>();
  take_cut();
  take_marks();
}

template <int Dim>
template <std::size_t N>
std::pair<int, int> Part<Dim>::count_around(const std::array<VertexId, N>& vertices) const {
  std::pair<int, int> count{0, 0};
  for (const ElementId e : topology_.elements_of(vertices[0])) {
    const auto& corners = topology_.corners_of[e];
    if (std::ranges::all_of(vertices, [&](VertexId v) { return contains(corners, v); }))
      ++(is_chosen_[e] ? count.first : count.second);
  }
  return count;
}

template <int Dim>
template <std::size_t N>
std::array<VertexId, N> Part<Dim>::local(std::array<VertexId, N> vertices) const {
  for (VertexId& v : vertices) v = local_of_[v];
  return vertices;
}

template <int Dim>
bool Part<Dim>::has_paths(std::span<const VertexId> vertices) const {
  return std::ranges::all_of(vertices, [&](VertexId v) { return whole_.path_of[v] != none; });
}

template <int Dim>
bool Part<Dim>::is_shared(VertexId vertex) const {
  return std::ranges::any_of(topology_.elements_of(vertices_[vertex]),
                             [&](ElementId e) { return !is_chosen_[e]; });
}

template <int Dim>
void Part<Dim>::take_vertices() {
  for (const ElementId e : elements_)
    for (const VertexId v : topology_.corners_of[e]) local_of_[v] = 0;
  for (std::size_t v = 0; v < local_of_.size(); ++v) {
    if (local_of_[v] == none) continue;
    local_of_[v] = static_cast<VertexId>(vertices_.size());
    vertices_.push_back(static_cast<VertexId>(v));
    const Vector<Dim>& position = whole_.site_of[v].position;
    mesh_.coordinates.insert(mesh_.coordinates.end(), position.x.begin(), position.x.end());
    mesh_.vertex_reference.push_back(whole_.any.vertex_reference[v]);
  }
  auto& cells = elements_in<Dim>(mesh_);
  for (const ElementId e : elements_)
    cells.add(local(topology_.corners_of[e]), elements_in<Dim>(whole_.any).reference[e]);
}

/// Takes the listed cells with N corners: facets, or edges of tetrahedra. Facets between the part
/// and the others follow in take_cut(), whether they are listed or not.
template <int Dim>
template <int N>
void Part<Dim>::take_listed() {
  const Cells<N>& listed = facets_in<N>(whole_.any);
  const auto required = marked(listed.size(), required_of<N>(whole_.any));
  const auto ridge = marked(whole_.any.edges.size(), whole_.any.ridges);
  Cells<N>& cells = facets_in<N>(mesh_);
  changes_[N - 2].assign(listed.size(), 0);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const auto& corners = listed.vertices[i];
    if (local_of_[corners[0]] == none) continue;
    const auto [inside, outside] = count_around(corners);
    if (inside == 0 || (N == Dim && outside != 0)) continue;
    const auto index = static_cast<std::uint32_t>(cells.size());
    const bool held = outside != 0 || required[i] || has_paths(corners);
    changes_[N - 2][i] = !held;
    if (held) required_of<N>(mesh_).push_back(index);
    if (N == 2 && ridge[i]) mesh_.ridges.push_back(index);
    cells.add(local(corners), held ? held_[N - 2] : listed.reference[i]);
  }
}

template <int Dim>
void Part<Dim>::take_cut() {
  auto& cells = facets_in<Dim>(mesh_);
  for (const ElementId e : elements_)
    for (int i = 0; i <= Dim; ++i) {
      const ElementId other = topology_.neighbour_of[e][static_cast<std::size_t>(i)];
      if (other == none || is_chosen_[other]) continue;
      required_of<Dim>(mesh_).push_back(static_cast<std::uint32_t>(cells.size()));
      cells.add(local(facet_of<Dim>(topology_.corners_of[e], i)), held_[Dim - 2]);
    }
}

template <int Dim>
void Part<Dim>::take_marks() {
  const auto required = marked(local_of_.size(), whole_.any.required_vertices);
  for (std::size_t v = 0; v < vertices_.size(); ++v)
    if (required[vertices_[v]] || whole_.path_of[vertices_[v]] != none)
      mesh_.required_vertices.push_back(static_cast<VertexId>(v));
  for (const std::uint32_t v : whole_.any.corners)
    if (local_of_[v] != none) mesh_.corners.push_back(local_of_[v]);
}

template <int Dim>
AnyField Part<Dim>::metric() const {
  AnyField field{Dim, vertices_.size(), {AnyField::Type::symmetric}, {}, mesh_.name};
  for (const VertexId v : vertices_) {
    const auto& m = whole_.site_of[v].metric.m;
    field.values.insert(field.values.end(), m.begin(), m.end());
  }
  return field;
}

/// Kept vertices come first, in their order; then the new ones.
template <int Dim>
PartNumbers Part<Dim>::number_vertices(const std::vector<VertexId>& origin_of,
                                       Renewal& renewal) const {
  std::vector<std::uint8_t> goes(local_of_.size(), 0);
  for (const VertexId v : vertices_) goes[v] = 1;
  for (const VertexId v : origin_of)
    if (v != none) goes[vertices_[v]] = 0;
  PartNumbers numbers{std::vector<VertexId>(goes.size(), none),
                      std::vector<VertexId>(origin_of.size(), none)};
  for (std::size_t v = 0; v < goes.size(); ++v) {
    if (goes[v]) continue;
    numbers.of_old[v] = static_cast<VertexId>(renewal.size());
    renewal.add_old(static_cast<VertexId>(v));
  }
  for (std::size_t v = 0; v < origin_of.size(); ++v) {
    numbers.of_part[v] = origin_of[v] != none ? numbers.of_old[vertices_[origin_of[v]]]
                                              : static_cast<VertexId>(renewal.size());
    if (origin_of[v] == none) renewal.add_part(static_cast<std::uint32_t>(v));
  }
  return numbers;
}

/// Replaces the listed cells that could change by those that the part came back with, which are the
/// ones whose reference is not that of held ones. Lists of their indices follow.
template <int Dim>
template <int N>
void Part<Dim>::renew_listed(AnyMesh& any, const AnyMesh& adapted,
                             const PartNumbers& numbers) const {
  const Cells<N> before = std::exchange(facets_in<N>(any), {});
  const Cells<N>& in_part = facets_in<N>(adapted);
  std::vector<std::uint32_t> of_old(before.size(), none), of_part(in_part.size(), none);
  const auto add = [&](std::uint32_t& index, const Cells<N>& from, std::size_t c,
                       const std::vector<VertexId>& number_of) {
    auto vertices = from.vertices[c];
    for (VertexId& v : vertices) v = number_of[v];
    index = static_cast<std::uint32_t>(facets_in<N>(any).size());
    facets_in<N>(any).add(vertices, from.reference[c]);
  };
  for (std::size_t c = 0; c < before.size(); ++c)
    if (!changes_[N - 2][c]) add(of_old[c], before, c, numbers.of_old);
  for (std::size_t c = 0; c < in_part.size(); ++c)
    if (in_part.reference[c] != held_[N - 2]) add(of_part[c], in_part, c, numbers.of_part);
  const auto renew_list = [&](std::vector<std::uint32_t>& list,
                              const std::vector<std::uint32_t>& of_adapted) {
    for (std::uint32_t& c : list) c = of_old[c];
    for (const std::uint32_t c : of_adapted) list.push_back(of_part[c]);
    std::erase(list, none);
  };
  renew_list(required_of<N>(any), required_of<N>(adapted));
  if (N == 2) renew_list(any.ridges, adapted.ridges);
}

template <int Dim>
void Part<Dim>::renew_elements(MovingMesh<Dim>& whole, const AnyMesh& adapted,
                               const PartNumbers& numbers, Renewal& renewal) const {
  const auto& cells = elements_in<Dim>(adapted);
  for (std::size_t e = 0; e < is_chosen_.size(); ++e)
    if (!is_chosen_[e]) renewal.add_old(static_cast<std::uint32_t>(e));
  for (std::size_t e = 0; e < cells.size(); ++e) renewal.add_part(static_cast<std::uint32_t>(e));
  const auto renumbered = [](Corners<Dim> corners, const std::vector<VertexId>& number_of) {
    for (VertexId& v : corners) v = number_of[v];
    return corners;
  };
  auto& elements = elements_in<Dim>(whole.any);
  for (std::size_t e = 0; e < is_chosen_.size(); ++e)
    if (!is_chosen_[e]) elements.vertices[e] = renumbered(elements.vertices[e], numbers.of_old);
  renew(elements.vertices, renewal,
        [&](auto e) { return renumbered(cells.vertices[e], numbers.of_part); });
  renew(elements.reference, renewal, [&](auto e) { return cells.reference[e]; });
  std::vector<std::uint32_t> index_of(is_chosen_.size(), none);
  for (std::size_t e = 0; e < renewal.size(); ++e)
    if (renewal.old_of[e] != none) index_of[renewal.old_of[e]] = static_cast<std::uint32_t>(e);
  for (std::uint32_t& e : Dim == 2 ? whole.any.required_triangles : whole.any.required_tetrahedra)
    e = index_of[e];  // these are never chosen
  for (auto* marks : {&whole.is_rigid, &whole.is_held})
    renew(*marks, renewal, [](auto) { return std::uint8_t{0}; });
  renew(whole.made_with, renewal, [](auto) { return -1.0; });  // measured when connected anew
  renew(whole.came_with, renewal, [](auto) { return 1.0; });
}

template <int Dim>
Renewals Part<Dim>::put_back(MovingMesh<Dim>& whole, const AdaptedPart<Dim>& adapted) const {
  Renewals renewals;
  const PartNumbers numbers = number_vertices(adapted.origins.vertex, renewals.vertices);
  renew_listed<2>(whole.any, adapted.mesh, numbers);
  if constexpr (Dim == 3) renew_listed<3>(whole.any, adapted.mesh, numbers);
  for (auto* list : {&whole.any.corners, &whole.any.required_vertices})
    for (std::uint32_t& v : *list) v = numbers.of_old[v];
  renew_elements(whole, adapted.mesh, numbers, renewals.elements);
  renew(whole.any.vertex_reference, renewals.vertices,
        [&](auto v) { return adapted.mesh.vertex_reference[v]; });
  renew(whole.site_of, renewals.vertices, [&](auto v) { return adapted.site_of[v]; });
  for (auto* vectors : {&whole.start_of, &whole.speed_of})
    renew(*vectors, renewals.vertices, [&](auto v) {
      Vector<Dim> mean;
      const auto& corners = elements_in<Dim>(mesh_).vertices[adapted.origins.host[v]];
      for (std::size_t i = 0; i <= Dim; ++i)
        mean += adapted.origins.weight[v * (Dim + 1) + i] * (*vectors)[vertices_[corners[i]]];
      return mean;
    });
  renew(whole.path_of, renewals.vertices, [](auto) { return none; });
  return renewals;
}

template class Part<2>;
template class Part<3>;

}  // namespace ductile::meshadapt
