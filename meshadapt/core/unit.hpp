/// @file
/// unit: the direction of a vector.
#pragma once

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The vector scaled to length 1; 0 if it is 0.
template <int Dim>
Vector<Dim> unit(const Vector<Dim>& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vector<Dim>{};
}

}  // namespace ductile::meshadapt
