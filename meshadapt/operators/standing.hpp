/// @file
/// Standing: how far a mesh is from its metric, to tell whether a run has made it better.
#pragma once

#include <cstddef>
#include <limits>

#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"
#include "operators/edge_range.hpp"

namespace ductile::meshadapt {

struct Standing {
  std::size_t elements = 0;
  double qualities = 0;  ///< sum of what the elements' mean ratios lack of 1
  double lengths = 0;    ///< sum of the share of each element's edges that are out of the range
  double poor = 0;       ///< elements of a mean ratio below that which counts as poor
  double far = 0;        ///< elements with an edge above twice the range, or below half of it
};

/// Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
Standing standing_of(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                     const EdgeRange& range, double poor);

/// How much less of a fault is clearly less: at most this part of it, and for each element less by
/// more than `least`. Where lengths are clearly better, `qualities` may be this many times as much.
struct Clearly {
  double part, least, qualities;
};
/// Differences that occur by chance from run to run do not count as clear.
inline constexpr Clearly after_a_run{.part = 0.85, .least = 0.01, .qualities = 1.02};
/// Mending changes few places, and lengths come first: qualities made for other lengths are better
/// than those made for these.
inline constexpr Clearly after_mending{
    .part = 0.9, .least = 0, .qualities = std::numeric_limits<double>::infinity()};

/// Is the one clearly better than the other? So it is, too, if less than half as many elements are
/// poor, or far from the range, or if there are less than half as many elements, no more of them
/// far from the range: where a thin wall is coarsened, elements become flatter.
bool is_better(const Standing& after, const Standing& before, const Clearly& clearly);

}  // namespace ductile::meshadapt
