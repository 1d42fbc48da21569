/// @file
/// Rules: the thresholds that the operators share. Lengths are metric lengths, shapes see shape().
#pragma once

namespace ductile::meshadapt {

struct Rules {
  double short_edge = 0.78;                ///< edges below this are collapsed, where shapes permit
  double long_edge = 1.41421356237309505;  ///< edges above this are split
  double too_short =
      0.70710678118654752;       ///< in the last iterations, collapses of edges below this
  double stretched_edge = 1.55;  ///< may make edges as long as this, to be split again
  double accepted_shape = 0.1;   ///< a collapse may not make elements worse than this ...
                                 ///< ... unless the worst before was no better
  double poor_shape = 0.01;      ///< from elements this bad a split makes none that are worse
  double split_keeps = 0.3;      ///< a split may lower the worst shape to this fraction
  double shortest_split = 0.5;   ///< a split makes no edge shorter than this
};

}  // namespace ductile::meshadapt
