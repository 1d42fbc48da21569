/// @file
/// Rounding: what is flat or straight in a mesh up to how precisely its coordinates were written.
/// Its new and moved vertices there are to be written alike, so that it is flat when it is read
/// again.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "mesh/mesh.hpp"
#include "mesh/precision.hpp"

namespace ductile::meshadapt {

/// A plane, by its normal, or a line, by its direction; both of unit length.
template <int Dim>
struct Flat {
  Vector<Dim> origin, direction;
};

template <int Dim>
struct Rounding {
  Precision precision;
  double tolerance = 0;  ///< how far what is flat, or straight, may be from a plane, or a line
  /// How far flat faces are from flat by noise that digits do not show; 0 if there is none, or not
  /// enough to tell, and with a Hausdorff tolerance.
  double noise = 0;
  std::vector<std::optional<Flat<Dim>>> plane_of;  ///< [patch], of those flat by rounding
  std::vector<std::optional<Flat<Dim>>> line_of;   ///< [curve], 3D

  /// The nearest position for a vertex of this class dimension that may not leave an entity: on its
  /// plane or line, written as precisely as the input.
  Vector<Dim> rounded(Vector<Dim> position, int class_dimension, std::uint32_t entity) const;
};

/// How far rounding may take what is flat: half a unit along each axis, and as much again because
/// planes are found from what was rounded.
template <int Dim>
double rounding_tolerance(const Precision& precision);

/// The plane that fits the points best.
template <int Dim>
Flat<Dim> best_plane(std::span<const Vector<Dim>> points);
/// The same, if all are within a distance of it.
template <int Dim>
std::optional<Flat<Dim>> plane_near(std::span<const Vector<Dim>> points, double distance);
/// The same for a line in space.
std::optional<Flat<3>> line_near(std::span<const Vector<3>> points, double distance);

/// The cosine of how far rounding may turn facets, at most.
inline constexpr double most_turn_by_rounding = 0.9;

/// Is the angle between two facets, or edges, within rounding error?
template <int Dim>
bool turns_by_rounding(const Vector<Dim>& u, const Vector<Dim>& v) {
  return std::abs(dot(u, v)) > most_turn_by_rounding * norm(u) * norm(v);
}

/// Is a point as far from the plane (2D: the line) of a facet as it may be if it is meant to be in
/// it, and both were rounded by the tolerance at most?
template <int Dim>
bool explains(const std::array<Vector<Dim>, Dim>& facet, const Vector<Dim>& point,
              double tolerance);
/// The same for the line through two points in space.
bool explains_line(const Vector<3>& a, const Vector<3>& b, const Vector<3>& point,
                   double tolerance);

/// How far flat boundaries and interfaces of a mesh may be from flat because of how precisely they
/// were written; 0 where all that is flat is so by all digits, and for what is not a valid mesh.
/// The result of adapt() may differ from the mesh by as much. Thread safety: any thread.
template <int Dim>
double roughness(const AnyMesh& mesh);

extern template struct Rounding<2>;
extern template struct Rounding<3>;

}  // namespace ductile::meshadapt
