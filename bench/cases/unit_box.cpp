#include "cases/unit_box.hpp"

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::bench {

using meshadapt::AnyMesh;

namespace {

template <int Dim>
double measure(const AnyMesh& mesh) {
  double sum = 0;
  for (const auto& corners : meshadapt::elements_in<Dim>(mesh).vertices) {
    std::array<meshadapt::Vector<Dim>, Dim + 1> place;
    for (std::size_t i = 0; i <= Dim; ++i) place[i] = meshadapt::position_in<Dim>(mesh, corners[i]);
    sum += meshadapt::plain_determinant(place) / (Dim == 2 ? 2 : 6);
  }
  return sum;
}

}  // namespace

bool fills_unit_box(const AnyMesh& mesh) {
  constexpr double tolerance = 1e-9;
  const bool inside = std::all_of(mesh.coordinates.begin(), mesh.coordinates.end(),
                                  [&](double x) { return x >= -tolerance && x <= 1 + tolerance; });
  const double all = mesh.dimension == 2 ? measure<2>(mesh) : measure<3>(mesh);
  return inside && std::abs(all - 1) < tolerance;
}

}  // namespace ductile::bench
