#include "support/counted_topology.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <set>

namespace ductile::meshadapt::test {

namespace {

using Corner = std::uint32_t;
using Some = std::vector<Corner>;  // ascending

class Union {
 public:
  explicit Union(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }
  std::size_t count() {
    std::size_t roots = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) roots += find(i) == i;
    return roots;
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Number of connected parts of cells, where cells with a common face of(cell) are connected.
std::size_t parts(const std::vector<Some>& cells,
                  const std::function<std::vector<Some>(const Some&)>& of) {
  Union sets(cells.size());
  std::map<Some, std::size_t> first;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const Some& face : of(cells[c])) sets.join(c, first.try_emplace(face, c).first->second);
  return sets.count();
}

std::vector<Some> subsets(const Some& cell, std::size_t size) {
  std::vector<Some> found;
  for (unsigned mask = 1; mask < 1U << cell.size(); ++mask) {
    Some some;
    for (std::size_t i = 0; i < cell.size(); ++i)
      if ((mask >> i & 1U) != 0) some.push_back(cell[i]);
    if (some.size() == size) found.push_back(some);
  }
  return found;
}

/// Number of excess parts of the facets around each vertex, if facets are connected by sharing
/// something besides the vertex.
std::size_t non_manifold_vertices(const std::vector<Some>& boundary, std::size_t dimension) {
  std::map<Corner, std::vector<Some>> around;
  for (const Some& facet : boundary)
    for (const Corner v : facet) around[v].push_back(facet);
  std::size_t count = 0;
  for (const auto& [v, facets] : around) {
    const Corner vertex = v;
    const auto joints = [&](const Some& facet) {
      auto all = subsets(facet, dimension - 1);
      all.erase(std::remove_if(all.begin(), all.end(),
                               [&](const Some& joint) {
                                 return std::find(joint.begin(), joint.end(), vertex) ==
                                        joint.end();
                               }),
                all.end());
      return all;
    };
    count += parts(facets, joints) - 1;
  }
  return count;
}

std::string line(const std::string& what, const std::vector<Some>& elements,
                 std::size_t dimension) {
  long euler = 0;
  for (std::size_t size = 1; size <= dimension + 1; ++size) {
    std::set<Some> simplices;
    for (const Some& element : elements)
      for (Some& some : subsets(element, size)) simplices.insert(std::move(some));
    euler += (size % 2 == 1 ? 1 : -1) * static_cast<long>(simplices.size());
  }
  std::map<Some, int> elements_at;
  for (const Some& element : elements)
    for (const Some& facet : subsets(element, dimension)) ++elements_at[facet];
  std::vector<Some> boundary;
  for (const auto& [facet, count] : elements_at)
    if (count == 1) boundary.push_back(facet);
  const auto facets = [&](const Some& cell) { return subsets(cell, dimension); };
  const auto corners = [](const Some& cell) { return subsets(cell, 1); };
  return what + ": Euler " + std::to_string(euler) + ", parts " +
         std::to_string(parts(elements, facets)) + " " + std::to_string(parts(elements, corners)) +
         ", around " + std::to_string(parts(boundary, corners)) + ", pinched " +
         std::to_string(dimension == 2 ? 0 : non_manifold_vertices(boundary, dimension));
}

}  // namespace

template <int Dim>
std::vector<std::string> counted_topology(const AnyMesh& mesh) {
  std::vector<Some> all;
  std::map<std::int32_t, std::vector<Some>> by_reference;
  const auto& cells = elements_in<Dim>(mesh);
  for (std::size_t e = 0; e < cells.size(); ++e) {
    Some corners(cells.vertices[e].begin(), cells.vertices[e].end());
    std::sort(corners.begin(), corners.end());
    by_reference[cells.reference[e]].push_back(corners);
    all.push_back(std::move(corners));
  }
  std::vector<std::string> lines = {line("all", all, Dim)};
  for (const auto& [reference, elements] : by_reference)
    lines.push_back(line("reference " + std::to_string(reference), elements, Dim));
  return lines;
}

template std::vector<std::string> counted_topology<2>(const AnyMesh&);
template std::vector<std::string> counted_topology<3>(const AnyMesh&);

}  // namespace ductile::meshadapt::test
