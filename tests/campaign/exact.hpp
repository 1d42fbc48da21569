/// @file
/// Signs that rounding cannot change: of an element's volume, and definiteness of a symmetric
/// tensor. Doubles decide where their error cannot matter, rational numbers otherwise.
#pragma once

#include <array>

#include "mesh.hpp"

namespace ductile::campaign {

/// 1 if a, b, c turn to the left, -1 if to the right, 0 if they lie on one line.
int orientation(const Point& a, const Point& b, const Point& c);

/// 1 if d lies on the side of a, b, c to which (b - a) x (c - a) points, -1 on the other, 0 on it.
int orientation(const Point& a, const Point& b, const Point& c, const Point& d);

/// The sign of an element's area or volume.
int orientation(const Mesh& mesh, const Cell& element);

/// Is the symmetric tensor (in the order of Field) positive definite?
bool is_positive_definite(const double* tensor, int dimension);

}  // namespace ductile::campaign
