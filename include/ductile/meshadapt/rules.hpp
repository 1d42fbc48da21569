/// @file
/// Rules: the thresholds that the operators share. Lengths are metric lengths, shapes see shape().
#pragma once

namespace ductile::meshadapt {

struct Rules {
  double short_edge = 0.70710678118654752;      ///< edges below this are collapsed ...
  double long_edge = 1.41421356237309505;       ///< edges above this are split
  double stretched_edge = 1.41421356237309505;  ///< ... if that makes no edge longer than this
  bool extends_long_edges = true;  ///< ... or than the longest edge there is around, nearly
  double accepted_shape = 0.1;     ///< a collapse may not make elements worse than this ...
  double kept_shape = 1;           ///< ... or than this fraction of the worst before, if that is
                                   ///< less: far from the metric, good shapes are still to come
  double poor_shape = 0.001;       ///< from elements this bad a split makes none that are worse ...
  double layer_split_keeps = 0.5;  ///< ... or than this fraction, on the sides of layers that the
                                   ///< elements span, where the layer is why they are bad
  double split_keeps = 0.3;        ///< a split may lower the worst shape to this fraction, if
                                   ///< that is less than accepted_shape ...
  double overlong_edge = 2;        ///< ... and of edges longer than this, to less by the square of
                                   ///< how much longer, which may be below poor_shape
  double shortest_split = 0.5;     ///< a split makes no edge shorter than this
};

}  // namespace ductile::meshadapt
