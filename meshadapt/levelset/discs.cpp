#include "levelset/discs.hpp"

#include <algorithm>

namespace ductile::meshadapt {

template <int Dim>
Discs<Dim>::Discs(const CutDomain<Dim>& domain, const std::vector<std::int8_t>& sign_of)
    : domain_(domain), sign_of_(sign_of), place_of_(sign_of.size()) {}

template <int Dim>
bool Discs<Dim>::at(VertexId vertex) {
  materials_.clear();
  for (const ElementId e : domain_.mesh.elements_of(vertex))
    if (const std::uint32_t m = domain_.material_of[e];
        domain_.is_split(e) && std::ranges::find(materials_, m) == materials_.end())
      materials_.push_back(m);
  return std::ranges::all_of(materials_, [&](std::uint32_t m) { return in_material(vertex, m); });
}

template <int Dim>
bool Discs<Dim>::in_material(VertexId vertex, std::uint32_t material) {
  link_.clear();
  ring_ = {};
  has_border_ = false;
  for (const ElementId e : domain_.mesh.elements_of(vertex)) {
    if (domain_.material_of[e] != material) continue;
    const Corners<Dim>& corners = domain_.mesh.corners_of[e];
    add_link(facet_of<Dim>(corners, corner_of(corners, vertex)));
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (corners[i] == vertex || !domain_.is_border(e, i)) continue;
      std::array<VertexId, Dim - 1> rim{};
      std::size_t n = 0;
      for (std::size_t k = 0; k <= Dim; ++k)
        if (k != i && corners[k] != vertex) rim[n++] = corners[k];
      add_border(rim);
    }
  }
  return is_disc();
}

template <int Dim>
void Discs<Dim>::add_link(const std::array<VertexId, 2>& edge) {
  ring_.add(sign(edge[0]), sign(edge[1]));
}

template <int Dim>
void Discs<Dim>::add_border(const std::array<VertexId, 1>&) {
  has_border_ = true;
}

template <int Dim>
void Discs<Dim>::add_link(const std::array<VertexId, 3>& triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexId here = triangle[i], next = triangle[(i + 1) % 3], last = triangle[(i + 2) % 3];
    link(here).around.add(sign(next), sign(last));
    if (sign(here) == 0 || sign(here) != sign(next)) continue;
    link(next);
    const std::uint32_t a = root(place_of_[here]), b = root(place_of_[next]);
    link_[std::max(a, b)].parent = std::min(a, b);
  }
}

template <int Dim>
void Discs<Dim>::add_border(const std::array<VertexId, 2>& edge) {
  has_border_ = true;
  ring_.add(sign(edge[0]), sign(edge[1]));
  for (const VertexId v : edge) link(v).on_border = true;
}

/// Where the surface meets the link it must be one closed line, or a line from border to border:
/// lines that do not branch, with one part of the link on either side. In 2D it meets it twice, or
/// once.
template <int Dim>
bool Discs<Dim>::is_disc() const {
  if constexpr (Dim == 2) return ring_.are(has_border_ ? 1 : 2);
  if (has_border_ && !ring_.are(2)) return false;
  for (const LinkVertex& v : link_)
    if (sign(v.id) == 0 && !v.around.are(v.on_border ? 1 : 2)) return false;
  return parts(-1) == 1 && parts(1) == 1;
}

template <int Dim>
auto Discs<Dim>::link(VertexId vertex) -> LinkVertex& {
  std::uint32_t& place = place_of_[vertex];
  if (place < link_.size() && link_[place].id == vertex) return link_[place];
  place = static_cast<std::uint32_t>(link_.size());
  return link_.emplace_back(LinkVertex{vertex, place, false, {}});
}

template <int Dim>
std::uint32_t Discs<Dim>::root(std::uint32_t i) const {
  while (link_[i].parent != i) i = link_[i].parent;
  return i;
}

template <int Dim>
int Discs<Dim>::parts(int sign) const {
  int count = 0;
  for (std::uint32_t i = 0; i < link_.size(); ++i)
    count += link_[i].parent == i && this->sign(link_[i].id) == sign;
  return count;
}

template class Discs<2>;
template class Discs<3>;

}  // namespace ductile::meshadapt
