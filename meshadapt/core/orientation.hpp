/// @file
/// orientation: the exact sign of an element's volume, for code that must not be wrong about it.
/// The kernels only need certain_determinant(), which may leave the sign open.
#pragma once

#include <array>

#include "core/determinant.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// 1 if the corners are positively oriented, -1 if negatively, 0 if they lie in one hyperplane or
/// one is not finite. Exact: rational arithmetic decides if floating point cannot. Thread safety:
/// any thread.
template <int Dim>
int orientation(const std::array<Vector<Dim>, Dim + 1>& corners);

extern template int orientation<2>(const std::array<Vector<2>, 3>&);
extern template int orientation<3>(const std::array<Vector<3>, 4>&);

}  // namespace ductile::meshadapt
