#include "helmholtz_filter.hpp"

namespace ductile::paper {

using meshadapt::ElementId;
using meshadapt::FixedMesh;

template <int Dim>
HelmholtzFilter<Dim>::HelmholtzFilter(const FixedMesh<Dim>& mesh, double length) : mesh_(mesh) {
  const double squared_radius = length * length / 12;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    entries.emplace_back(static_cast<int>(v), static_cast<int>(v), mesh.share_of[v]);
  for (ElementId e = 0; e < mesh.element_count(); ++e) {
    const auto gradient = meshadapt::hat_gradients<Dim>(mesh.points(e));
    for (std::size_t a = 0; a <= Dim; ++a)
      for (std::size_t b = 0; b <= Dim; ++b) {
        const auto row = static_cast<int>(mesh.corners_of[e][a]);
        const auto column = static_cast<int>(mesh.corners_of[e][b]);
        if (row >= column)
          entries.emplace_back(row, column,
                               squared_radius * mesh.volume_of[e] * dot(gradient[a], gradient[b]));
      }
  }
  const auto size = static_cast<int>(mesh.vertex_count());
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  solver_.factorise(matrix);
}

template <int Dim>
std::vector<double> HelmholtzFilter<Dim>::smooth(const std::vector<double>& value_of) const {
  std::vector<double> integral_of = value_of;
  for (std::size_t v = 0; v < value_of.size(); ++v) integral_of[v] *= mesh_.share_of[v];
  return smooth_integrated(integral_of);
}

template <int Dim>
std::vector<double> HelmholtzFilter<Dim>::smooth_integrated(
    const std::vector<double>& integral_of) const {
  const Values right =
      Eigen::Map<const Values>(integral_of.data(), static_cast<Eigen::Index>(integral_of.size()));
  const Values result = solver_.solve(right, Values::Zero(right.size()));
  return {result.begin(), result.end()};
}

template class HelmholtzFilter<2>;
template class HelmholtzFilter<3>;

}  // namespace ductile::paper
