/// @file
/// Rules: the thresholds that the operators share. Lengths are metric lengths, qualities those of
/// quality().
#pragma once

namespace ductile::meshadapt {

/// What is too short, too long or too bad, and what a change may make of it.
struct Rules {
  /// Edges shorter than this are collapsed.
  double short_edge = 0.70710678118654752;
  /// Edges longer than this are split.
  double long_edge = 1.41421356237309505;
  /// A collapse is refused if it makes an edge longer than this and, with extends_long_edges,
  /// longer than nearly the longest edge that there is around already.
  double stretched_edge = 1.41421356237309505;
  bool extends_long_edges = true;  ///< see stretched_edge
  /// A collapse is refused if it makes an element worse than min(accepted_quality, kept_quality *
  /// worst quality in the old cavity): far from the metric, good elements are still to come.
  double accepted_quality = 0.1;
  double kept_quality = 1;  ///< see accepted_quality
  /// An element worse than this may not be split into worse ones, except on the sides of layers
  /// that the elements span, where the layer is why they are bad: there each part must keep
  /// layer_split_keeps of the quality.
  double poor_quality = 0.001;
  double layer_split_keeps = 0.5;  ///< see poor_quality
  /// A split is refused if it makes an element worse than min(accepted_quality, split_keeps * worst
  /// quality before). For edges longer than overlong_edge that bound falls by the square of how
  /// much longer they are, also below poor_quality.
  double split_keeps = 0.3;
  double overlong_edge = 2;     ///< see split_keeps
  double shortest_split = 0.5;  ///< a split is refused if it makes an edge shorter than this
};

}  // namespace ductile::meshadapt
