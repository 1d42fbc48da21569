/// @file
/// Tuning: what the driver does differently in two and in three dimensions.
#pragma once

#include <limits>

#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {

/// How much is done for better elements.
struct Care {
  double calm;   ///< share of changes below which the mesh is near the metric
  int polishes;  ///< passes
  double far;    ///< of SmoothOptions
};

/// What differs between the dimensions. Shares are of the number of elements.
template <int Dim>
struct Tuning;

template <>
struct Tuning<2> {
  /// How much longer than the rules want edges must be to be split, by stage.
  static constexpr double stages[] = {1};
  static constexpr Care normal{.calm = 0.03, .polishes = 1, .far = 0.16};
  static constexpr Care thorough{.calm = 0.03, .polishes = 2, .far = 0.08};
  static constexpr double kept_quality = 0.5;    ///< of Rules, on the way to the metric
  static constexpr double stretched_edge = 1.7;  ///< as far as rearranging may lengthen edges
  static constexpr int rearrangements = 4;       ///< passes
  static constexpr double swap_below = 0.9;      ///< mean ratio of elements that are swapped
  static constexpr double optimise_below = 0.8;  ///< of those that are optimised in the end
  /// ... and of those around a vertex on the whole where they are finished together.
  static constexpr double mean_below = 0.9;
  static constexpr double far = 0.003;  ///< of most elements where the metric is far from the mesh
};

template <>
struct Tuning<3> {
  /// Coarsening and swapping shorten many long edges, so the first stage splits none, and each
  /// after it what is left of the longest.
  static constexpr double stages[] = {std::numeric_limits<double>::infinity(), 2.5, 1.7, 1.25, 1};
  static constexpr Care normal{.calm = 0.1, .polishes = 1, .far = 0.2};
  static constexpr Care thorough{.calm = 0.05, .polishes = 2, .far = 0.08};
  static constexpr double kept_quality = 0.2;
  static constexpr double stretched_edge = 1.55;
  static constexpr int rearrangements = 2;
  static constexpr double swap_below = 0.8;
  static constexpr double optimise_below = 0.6;
  static constexpr double mean_below = 0;
  static constexpr double far = 0.012;
};

template <int Dim>
const Care& care_of(const AdaptOptions& options) {
  return options.thorough ? Tuning<Dim>::thorough : Tuning<Dim>::normal;
}

}  // namespace ductile::meshadapt
