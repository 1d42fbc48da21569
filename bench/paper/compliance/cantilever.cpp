#include "cantilever.hpp"

#include <cmath>

#include "settings.hpp"

namespace ductile::paper {

using meshadapt::AnyMesh;
using meshadapt::Facet;
using meshadapt::VertexId;

namespace {

AnyMesh box(std::integral_constant<int, 2> /*dimension*/, int cells) {
  return meshadapt::box_mesh<2>({1, height}, {2 * cells, cells});
}
AnyMesh box(std::integral_constant<int, 3> /*dimension*/, int cells) {
  return meshadapt::box_mesh({1, height, width}, {2 * cells, cells, cells / 2});
}

}  // namespace

template <int Dim>
AnyMesh cantilever_mesh(int cells) {
  AnyMesh mesh = box(std::integral_constant<int, Dim>{}, cells);
  auto& facets = meshadapt::facets_in<Dim>(mesh);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    double middle = 0;
    for (const VertexId v : facets.vertices[f]) middle += mesh.coordinates[v * Dim + 1] / Dim;
    if (facets.reference[f] == meshadapt::Side::right &&
        std::abs(middle - height / 2) < height / 10)
      facets.reference[f] = pulled_reference;
  }
  return mesh;
}

template <int Dim>
std::vector<Facet<Dim>> facets_with(const AnyMesh& mesh, int reference) {
  std::vector<Facet<Dim>> result;
  const auto& facets = meshadapt::facets_in<Dim>(mesh);
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (facets.reference[f] == reference) result.push_back(facets.vertices[f]);
  return result;
}

template AnyMesh cantilever_mesh<2>(int);
template AnyMesh cantilever_mesh<3>(int);
template std::vector<Facet<2>> facets_with<2>(const AnyMesh&, int);
template std::vector<Facet<3>> facets_with<3>(const AnyMesh&, int);

}  // namespace ductile::paper
