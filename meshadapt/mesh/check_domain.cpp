#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/vector.hpp"
#include "mesh/array_lengths.hpp"

namespace ductile::meshadapt {

namespace {

/// Measures by reference: of listed facets; that of all elements stands beside them.
struct Measures {
  double domain = 0;
  std::map<std::int32_t, double> facets;
};

template <int Dim>
Vector<Dim> point(const AnyMesh& mesh, std::uint32_t vertex) {
  Vector<Dim> result;
  for (int i = 0; i < Dim; ++i)
    result[i] =
        mesh.coordinates[static_cast<std::size_t>(vertex) * Dim + static_cast<std::size_t>(i)];
  return result;
}

Measures measures_2d(const AnyMesh& mesh) {
  Measures sum;
  for (const auto& t : mesh.triangles.vertices) {
    const Vector<2> a = point<2>(mesh, t[0]);
    const Vector<2> u = point<2>(mesh, t[1]) - a, v = point<2>(mesh, t[2]) - a;
    sum.domain += std::abs(u[0] * v[1] - u[1] * v[0]) / 2;
  }
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    const auto& [a, b] = mesh.edges.vertices[i];
    const Vector<2> along = point<2>(mesh, b) - point<2>(mesh, a);
    sum.facets[mesh.edges.reference[i]] += std::sqrt(dot(along, along));
  }
  return sum;
}

Measures measures_3d(const AnyMesh& mesh) {
  Measures sum;
  for (const auto& t : mesh.tetrahedra.vertices) {
    const Vector<3> a = point<3>(mesh, t[0]);
    const Vector<3> normal = cross(point<3>(mesh, t[1]) - a, point<3>(mesh, t[2]) - a);
    sum.domain += std::abs(dot(normal, point<3>(mesh, t[3]) - a)) / 6;
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles.vertices[i];
    const Vector<3> a = point<3>(mesh, t[0]);
    const Vector<3> normal = cross(point<3>(mesh, t[1]) - a, point<3>(mesh, t[2]) - a);
    sum.facets[mesh.triangles.reference[i]] += std::sqrt(dot(normal, normal)) / 2;
  }
  return sum;
}

/// How far a mesh reaches, and how far its boundary may go astray: what counts as flat is so by
/// this fraction of the extent (see classify.cpp), and coordinates are rounded.
struct Scale {
  double extent = 0, slack = 0;
};

template <int Dim>
Scale scale_of(const AnyMesh& mesh) {
  Scale scale;
  if (mesh.coordinates.empty()) return scale;
  double farthest = 0;
  for (std::size_t i = 0; i < Dim; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t at = i; at < mesh.coordinates.size(); at += Dim) {
      low = std::min(low, mesh.coordinates[at]);
      high = std::max(high, mesh.coordinates[at]);
    }
    scale.extent = std::max(scale.extent, high - low);
    farthest = std::max({farthest, std::abs(low), std::abs(high)});
  }
  scale.slack = 2e-10 * scale.extent + 16 * std::numeric_limits<double>::epsilon() * farthest;
  return scale;
}

/// Says what differs by more than is allowed, with as many digits as show it.
void compare(const std::string& what, double now, double expected, double allowed,
             std::vector<std::string>& faults) {
  if (std::abs(now - expected) <= allowed) return;
  std::ostringstream text;
  text.precision(17);
  text << what << now << ", expected " << expected;
  text.precision(3);
  text << " up to " << allowed;
  faults.push_back(text.str());
}

}  // namespace

std::vector<std::string> check_domain(const AnyMesh& before, const AnyMesh& after,
                                      double surface_tolerance) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_coordinates(*mesh);
    expect_references(*mesh);
  }
  if (after.dimension != before.dimension)
    throw InputError(after.name + ": expected dimension " + std::to_string(before.dimension) +
                     ", that of " + before.name + ", found " + std::to_string(after.dimension));
  const auto measure = [](const AnyMesh& mesh) {
    return mesh.dimension == 2 ? measures_2d(mesh) : measures_3d(mesh);
  };
  const Measures old = measure(before);
  Measures now = measure(after);
  const auto [extent, slack] = before.dimension == 2 ? scale_of<2>(before) : scale_of<3>(before);
  double total = 0;
  for (const auto& [reference, value] : old.facets) total += value;
  std::vector<std::string> faults;
  compare("the domain measures ", now.domain, old.domain,
          1e-9 * old.domain + (slack + surface_tolerance) * total, faults);
  // The rim of a patch of facets: two points in 2D, in 3D a line about as long as the mesh.
  const double rim = before.dimension == 2 ? 2 : 4 * extent;
  for (const auto& [reference, value] : old.facets) {
    const std::string what = "facets of reference " + std::to_string(reference);
    if (surface_tolerance == 0)
      compare(what + " measure ", now.facets[reference], value, 1e-9 * total + slack * rim, faults);
    else if (!(now.facets[reference] > 0))
      faults.push_back(what + " are gone");
  }
  return faults;
}

}  // namespace ductile::meshadapt
