#include "support/preserved.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "ductile/meshadapt/check_mesh.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::test {

namespace {

using Lines = std::vector<std::string>;
using Measures = std::map<std::string, double>;

template <int Dim>
double volume(const AnyMesh& mesh, const Corners<Dim>& corners) {
  const Vector<Dim> origin = point<Dim>(mesh, corners[0]);
  const auto side = [&](std::size_t i) { return point<Dim>(mesh, corners[i]) - origin; };
  if constexpr (Dim == 2)
    return 0.5 * (side(1)[0] * side(2)[1] - side(1)[1] * side(2)[0]);
  else
    return dot(side(1), cross(side(2), side(3))) / 6;
}

template <int Dim, std::size_t N>
double measure(const AnyMesh& mesh, const std::array<std::uint32_t, N>& corners) {
  const Vector<Dim> origin = point<Dim>(mesh, corners[0]);
  if constexpr (N == 2)
    return norm(point<Dim>(mesh, corners[1]) - origin);
  else
    return 0.5 *
           norm(cross(point<3>(mesh, corners[1]) - origin, point<3>(mesh, corners[2]) - origin));
}

template <int Dim>
Measures measures(const AnyMesh& mesh) {
  Measures sum;
  const auto& cells = elements<Dim>(mesh);
  for (std::size_t e = 0; e < cells.size(); ++e)
    sum["region " + std::to_string(cells.reference[e])] += volume<Dim>(mesh, cells.vertices[e]);
  for (const auto& [facet, owners] : facet_elements<Dim>(mesh)) {
    if (owners.size() != 2) continue;
    const auto [low, high] = std::minmax(cells.reference[owners[0]], cells.reference[owners[1]]);
    if (low != high)
      sum["interface " + std::to_string(low) + "-" + std::to_string(high)] +=
          measure<Dim>(mesh, facet);
  }
  const auto& listed = facets<Dim>(mesh);
  for (std::size_t f = 0; f < listed.size(); ++f)
    sum["facets " + std::to_string(listed.reference[f])] += measure<Dim>(mesh, listed.vertices[f]);
  if constexpr (Dim == 3)
    for (std::size_t i = 0; i < mesh.edges.size(); ++i)
      sum["edges " + std::to_string(mesh.edges.reference[i])] +=
          measure<Dim>(mesh, mesh.edges.vertices[i]);
  for (const std::uint32_t i : mesh.ridges)
    sum["ridges"] += measure<Dim>(mesh, mesh.edges.vertices[i]);
  return sum;
}

struct Tolerance {
  double of_each;  ///< relative to each measure
  double of_all;   ///< relative to the sum of all, for rounding of the coordinates
};

void compare(Lines& lines, const Measures& before, const Measures& after,
             const Tolerance& tolerance) {
  double all = 0;
  for (const auto& [name, value] : before) all += std::abs(value);
  for (const auto& [name, value] : before) {
    const auto found = after.find(name);
    const double allowed = tolerance.of_each * std::abs(value) + tolerance.of_all * all;
    if (found == after.end())
      lines.push_back(name + " is gone");
    else if (!(std::abs(found->second - value) <= allowed))
      lines.push_back(name + " measured " + std::to_string(value) + ", now differs by " +
                      std::to_string(1e9 * (found->second - value) / value) + "e-9 of that");
  }
  for (const auto& [name, value] : after)
    if (!before.contains(name)) lines.push_back(name + " is new");
}

template <int Dim>
using Place = std::array<double, Dim>;

/// Identifies an entity by the exact coordinates of its corners, which are the same in both meshes.
template <int Dim, std::size_t N>
std::pair<std::vector<Place<Dim>>, std::int32_t> by_place(
    const AnyMesh& mesh, const std::array<std::uint32_t, N>& corners, std::int32_t reference) {
  std::vector<Place<Dim>> places;
  places.reserve(N);
  for (const std::uint32_t v : corners) places.push_back(point<Dim>(mesh, v).x);
  std::sort(places.begin(), places.end());
  return {places, reference};
}

struct Both {
  const AnyMesh &before, &after;
};

template <int Dim, int N>
void compare_required(Lines& lines, const Both& both, Cells<N> AnyMesh::*cells,
                      std::vector<std::uint32_t> AnyMesh::*required, const char* name) {
  const auto all = [&](const AnyMesh& mesh) {
    std::multiset<std::pair<std::vector<Place<Dim>>, std::int32_t>> set;
    for (const std::uint32_t i : mesh.*required)
      set.insert(by_place<Dim>(mesh, (mesh.*cells).vertices[i], (mesh.*cells).reference[i]));
    return set;
  };
  if (all(both.before) != all(both.after))
    lines.push_back(std::string("required ") + name + " changed");
}

template <int Dim>
void compare_vertices(Lines& lines, const AnyMesh& before, const AnyMesh& after,
                      std::vector<std::uint32_t> AnyMesh::*list, const char* name) {
  const auto all = [&](const AnyMesh& mesh) {
    std::set<std::pair<std::vector<Place<Dim>>, std::int32_t>> set;
    for (const std::uint32_t v : mesh.*list)
      set.insert(by_place<Dim>(mesh, std::array{v}, mesh.vertex_reference[v]));
    return set;
  };
  if (all(before) != all(after)) lines.push_back(std::string(name) + " changed");
}

/// Every corner must remain. Vertices with references may become corners: see marked_points().
template <int Dim>
void compare_corners(Lines& lines, const AnyMesh& before, const AnyMesh& after) {
  using Corner = std::pair<std::vector<Place<Dim>>, std::int32_t>;
  const auto at = [](const AnyMesh& mesh, std::uint32_t v) {
    return Corner{by_place<Dim>(mesh, std::array{v}, mesh.vertex_reference[v])};
  };
  std::set<Corner> missing, allowed, found;
  for (const std::uint32_t v : before.corners) missing.insert(at(before, v));
  for (std::uint32_t v = 0; v < before.vertex_count(); ++v)
    if (before.vertex_reference[v] != 0) allowed.insert(at(before, v));
  allowed.insert(missing.begin(), missing.end());
  for (const std::uint32_t v : after.corners) found.insert(at(after, v));
  if (!std::includes(found.begin(), found.end(), missing.begin(), missing.end()) ||
      !std::includes(allowed.begin(), allowed.end(), found.begin(), found.end()))
    lines.emplace_back("corners changed");
}

/// The tolerance for flatness and measures: far from the origin, both are known only up to
/// rounding.
template <int Dim>
Tolerance tolerance(const AnyMesh& mesh) {
  double largest = 0, extent = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    largest = std::max(largest, norm(point<Dim>(mesh, v)));
    extent = std::max(extent, norm(point<Dim>(mesh, v) - point<Dim>(mesh, 0)));
  }
  return {1e-9, 1e-15 * largest / extent};
}

template <int Dim>
Lines changes_in(const AnyMesh& before, const AnyMesh& after) {
  Lines lines;
  compare(lines, measures<Dim>(before), measures<Dim>(after), tolerance<Dim>(before));
  compare_corners<Dim>(lines, before, after);
  compare_vertices<Dim>(lines, before, after, &AnyMesh::required_vertices, "required vertices");
  compare_required<Dim>(lines, {before, after}, &AnyMesh::edges, &AnyMesh::required_edges, "edges");
  compare_required<Dim>(lines, {before, after}, &AnyMesh::triangles, &AnyMesh::required_triangles,
                        "triangles");
  if constexpr (Dim == 3)
    compare_required<Dim>(lines, {before, after}, &AnyMesh::tetrahedra,
                          &AnyMesh::required_tetrahedra, "tetrahedra");
  return lines;
}

template <int Dim>
bool all_positive(const AnyField& field) {
  if (field.values.size() != field.vertex_count * Metric<Dim>::size) return false;
  for (std::size_t v = 0; v < field.vertex_count; ++v) {
    Metric<Dim> metric;
    std::copy_n(&field.values[v * Metric<Dim>::size], Metric<Dim>::size, metric.m.begin());
    for (const double m : metric.m)
      if (!std::isfinite(m)) return false;
    for (int i = 0; i < Dim; ++i)
      if (!(metric(i, i) > 0)) return false;
  }
  return true;
}

}  // namespace

Lines changes_of_what_is_kept(const AnyMesh& before, const AnyMesh& after) {
  return before.dimension == 2 ? changes_in<2>(before, after) : changes_in<3>(before, after);
}

Lines faults_of(const runtime::Executor& executor, const AnyMesh& before,
                const AdaptedMesh& after) {
  Lines lines = check_mesh(executor, after.mesh);
  if (lines.empty()) lines = changes_of_what_is_kept(before, after.mesh);
  const bool positive =
      before.dimension == 2 ? all_positive<2>(after.metric) : all_positive<3>(after.metric);
  if (!positive || after.metric.vertex_count != after.mesh.vertex_count())
    lines.push_back("a vertex has no metric that is finite and positive");
  return lines;
}

void require_facets(AnyMesh& mesh) {
  auto& required = mesh.dimension == 2 ? mesh.required_edges : mesh.required_triangles;
  required.resize(mesh.dimension == 2 ? mesh.edges.size() : mesh.triangles.size());
  std::iota(required.begin(), required.end(), 0U);
}

std::string joined(const Lines& lines) {
  std::string all;
  for (const std::string& line : lines) all += "\n  " + line;
  return all;
}

}  // namespace ductile::meshadapt::test
