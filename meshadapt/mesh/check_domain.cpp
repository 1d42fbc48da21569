#include <cmath>
#include <cstdlib>
#include <map>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/vector.hpp"

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

bool agree(double a, double b, double total) { return std::abs(a - b) <= 1e-9 * total; }

}  // namespace

std::vector<std::string> check_domain(const AnyMesh& before, const AnyMesh& after) {
  const auto measure = [](const AnyMesh& mesh) {
    return mesh.dimension == 2 ? measures_2d(mesh) : measures_3d(mesh);
  };
  const Measures old = measure(before);
  Measures now = measure(after);
  std::vector<std::string> faults;
  if (!agree(old.domain, now.domain, old.domain))
    faults.push_back("the domain measures " + std::to_string(now.domain) + ", expected " +
                     std::to_string(old.domain));
  double total = 0;
  for (const auto& [reference, value] : old.facets) total += value;
  for (const auto& [reference, value] : old.facets)
    if (!agree(value, now.facets[reference], total))
      faults.push_back("facets of reference " + std::to_string(reference) + " measure " +
                       std::to_string(now.facets[reference]) + ", expected " +
                       std::to_string(value));
  return faults;
}

}  // namespace ductile::meshadapt
