/// @file
/// Tuning: the driver's constants and why they were chosen; the trials are in
/// docs/notebook/tried-in-adaptation.md. How often steps run is in schedule.hpp, thresholds of
/// kernels in adapt_options.hpp (Rules). Shares are of the number of elements.
#pragma once

#include <cstddef>
#include <limits>

#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {

/// Bounds that no share or length exceeds, or falls below.
inline constexpr double never = std::numeric_limits<double>::infinity(), always = -1;

/// Constants for both dimensions.
struct Thresholds {
  // ---- A mesh that comes adapted (decision 27) ----
  static constexpr double nothing = 2e-4;    ///< to change: it is left alone
  static constexpr double little = 0.02;     ///< to change: it is only mended
  static constexpr double not_much = 0.06;   ///< to change: it is mended, unless adapting it anew
                                             ///< makes it clearly better
  static constexpr double many_poor = 5e-3;  ///< may hide what there is to do
  static constexpr std::size_t least_count = 100;  ///< elements; one change is no small share of a
                                                   ///< small mesh, but it is little work

  // ---- A metric that is far from the mesh (decisions 19 and 33) ----
  static constexpr double most_slivers = 0.5;    ///< in the metric: it is far
  static constexpr double some_slivers = 0.02;   ///< it is far if sizes jump or surfaces bend, too
  static constexpr double much_of_demand = 0.2;  ///< share of the elements asked for that lie where
                                                 ///< sizes jump
  static constexpr int rounds_on_the_way = 6;    ///< to each metric, at most
  static constexpr double near = 0.1;            ///< changed by a round: the next metric may come
  static constexpr double too_many = 1.5;  ///< times the elements asked for: the way is cut short

  // ---- The end of the approach: a thin layer that is split in halves begins with few changes ----
  static constexpr double hardly_any = 5e-3;       ///< changed by a round: it is over
  static constexpr double many_splits_left = 0.1;  ///< it is not over

  // ---- Kernels ----
  static constexpr double many_collapses = 0.1;  ///< by one sweep; what fewer leave is mostly
                                                 ///< refused until other kernels change something
  static constexpr double many_swaps = 0.015;    ///< the same for swaps
  static constexpr double any_swaps = 5e-5;      ///< the same in the end
  static constexpr int most_rounds = 30;  ///< collapses may wake each other many times, for little
  static constexpr double eager = 1.03;   ///< rearranging collapses edges that are hardly long
                                          ///< enough: some would end up too short
};

/// How much is done for better elements.
struct Care {
  double calm;   ///< share of changes below which the mesh is near the metric
  int polishes;  ///< passes
  double far;    ///< of SmoothOptions
};

/// Constants that differ between the dimensions.
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
  /// Order matters less than the time to restore it, unless much has changed.
  static constexpr double renumber_above = 0.05;
};

template <>
struct Tuning<3> {
  /// Coarsening and swapping shorten many long edges, so the first stage splits none, and each
  /// after it what is left of the longest.
  static constexpr double stages[] = {never, 2.5, 1.7, 1.25, 1};
  static constexpr Care normal{.calm = 0.1, .polishes = 1, .far = 0.2};
  static constexpr Care thorough{.calm = 0.05, .polishes = 2, .far = 0.08};
  static constexpr double kept_quality = 0.2;
  static constexpr double stretched_edge = 1.55;
  static constexpr int rearrangements = 2;
  static constexpr double swap_below = 0.8;
  static constexpr double optimise_below = 0.6;
  static constexpr double mean_below = 0;
  static constexpr double far = 0.012;
  static constexpr double renumber_above = always;
};

template <int Dim>
const Care& care_of(const AdaptOptions& options) {
  return options.thorough ? Tuning<Dim>::thorough : Tuning<Dim>::normal;
}

}  // namespace ductile::meshadapt
