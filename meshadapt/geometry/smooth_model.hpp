/// @file
/// SmoothModel: what the facets and curve edges of a surface seem to be pieces of. Each becomes a
/// cubic piece whose sides follow the surface's normals at its vertices, or its curve's tangents,
/// so that pieces meet. It knows nothing of elements, nor of what becomes of the surface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/curved_simplex.hpp"
#include "geometry/samples.hpp"

namespace ductile::meshadapt {

/// A facet before it is curved.
template <int Dim>
struct ModelFacet {
  std::array<std::uint32_t, Dim> corner;  ///< among the points
  std::uint32_t patch;
  std::uint32_t plane;  ///< facets of one patch that have the same number here are coplanar
  bool smooth;          ///< the patch may bend
  bool held = false;    ///< this facet may not
};

/// An edge of a curve, in 3D; it stays straight if one of its facets is held. Facets of all patches
/// that have it as a side follow it.
struct ModelEdge {
  std::array<std::uint32_t, 2> corner;  ///< among the points
  bool smooth;                          ///< the curve may bend
  bool ridge = false;                   ///< it is one however little facets turn there
};

template <int Dim>
struct ModelInput {
  std::vector<Vector<Dim>> points;
  std::vector<ModelFacet<Dim>> facets;
  std::vector<ModelEdge> edges;
  std::vector<std::uint8_t> ends;  ///< [point], whether what is smooth ends there
  double tolerance;                ///< how far pieces may be from their facets
  double flat;                     ///< how far points of a straight line are from it at most
  double least_turn;               ///< cosine of the angle from which on curves end
};

/// Normals are those of quadrics fitted to the vertices around, tangents those of circles through
/// three vertices. What is coplanar stays flat if it surrounds a vertex, or if it turns by too much
/// at its sides for an arc within the tolerance of it; what is collinear stays straight.
template <int Dim>
struct SmoothModel {
  template <std::size_t Corners>
  using Pieces = std::vector<std::optional<CurvedSimplex<Dim, Corners>>>;

  Pieces<Dim> facets;  ///< [facet], nothing where it is flat
  Pieces<2> edges;     ///< [edge], nothing where it is straight
  Samples<Dim, Dim> facet_samples;
  Samples<Dim, 2> edge_samples;

  /// Linear in the input, times a logarithm. Thread safety: one caller; runs on the executor.
  SmoothModel(const runtime::Executor& executor, const ModelInput<Dim>& input);
};

template <>
SmoothModel<2>::SmoothModel(const runtime::Executor& executor, const ModelInput<2>& input);
template <>
SmoothModel<3>::SmoothModel(const runtime::Executor& executor, const ModelInput<3>& input);

}  // namespace ductile::meshadapt
