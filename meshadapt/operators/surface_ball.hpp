/// @file
/// VertexBall<2, 3>: the triangles of a surface around a vertex, as edges under an apex that may
/// move, eight side by side. Qualities are those of quality(), -1 where a triangle turns over.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/lanes.hpp"
#include "operators/ball.hpp"

namespace ductile::meshadapt {

template <>
class VertexBall<2, 3> {
 public:
  struct Score {
    double worst = 0, sum = 0;
  };
  using Qualities = BallQualities<2>;

  VertexBall(const Mesh<2, 3>& mesh, VertexId vertex)
      : instructions_(mesh.instructions),
        vertex_(vertex),
        origin_(mesh.site_of[vertex].position),
        size_(mesh.elements_of.of(vertex).size()) {
    blocks_.resize((size_ + lane_count - 1) / lane_count, boost::container::default_init);
    for (std::size_t b = 0; b < blocks_.size(); ++b) fill(mesh, b);
  }

  VertexId vertex() const { return vertex_; }
  std::size_t size() const { return size_; }

  /// Worst and sum of all qualities as the mesh has them.
  Score present() const {
    float worst = 1, sum = 0;
    for (const Block& block : blocks_) {
      worst = std::min(worst, least(block.quality));
      for (std::size_t l = 0; l < lane_count; ++l) sum += block.counts[l] * block.quality[l];
    }
    return {worst, sum};
  }

  /// Worst and sum of all qualities with this apex; just a worst of -1 if one is below the bound,
  /// turns over or is not a number.
  Score score(const Site<3>& apex, double bound) const {
    Qualities qualities;
    return score(apex, bound, qualities);
  }
  /// The same; sets the qualities, too.
  Score score(const Site<3>& apex, double bound, Qualities& qualities) const {
    if (!(apex.scale > 0)) return {-1, 0};
    float worst = 1, sum = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const QualityLanes quality = run_with(instructions_, [&] { return judge(blocks_[b], apex); });
      worst = std::min(worst, least(quality));
      if (!(worst > 0) || worst < bound) return {-1, 0};
      if (b < Qualities::blocks) qualities.lanes[b] = quality;
      for (std::size_t l = 0; l < lane_count; ++l) sum += blocks_[b].counts[l] * quality[l];
    }
    if (!(sum > 0) || std::isinf(sum)) return {-1, 0};  // least() may overlook what is no number
    return {worst, sum};
  }

  /// Calls visit(i, quality) for each element.
  void visit_qualities(const Site<3>& apex, auto&& visit) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const QualityLanes quality = run_with(instructions_, [&] { return judge(blocks_[b], apex); });
      const std::size_t begin = b * lane_count, end = std::min(size_, begin + lane_count);
      for (std::size_t i = begin; i < end; ++i) visit(i, static_cast<double>(quality[i - begin]));
    }
  }

  /// As in two and three dimensions: the mean of the places, each in the plane of its triangle,
  /// where triangles would be regular, or half-way from there to where their edges have length 1.
  Vector<3> mean_pull(const Site<3>& site) const {
    Vector<3> sum;
    double weights = 0;
    for (const Block& block : blocks_)
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double weight = block.counts[l] / std::max(0.01F, block.quality[l]);
        const Vector<3> side = at(block.side, l), seen = product(site.metric, side);
        const Vector<3> centre = at(block.first, l) + 0.5 * side;
        const double square = dot(side, seen);
        const Vector<3> up = (dot(centre, seen) / square) * side - centre;
        const double height = std::sqrt(squared_length(site.metric, up));
        if (!(height > 0)) continue;
        sum += weight * (centre + (std::sqrt(0.75 * std::sqrt(square)) / height) * up);
        weights += weight;
      }
    return weights > 0 ? (1 / weights) * sum : sum;
  }

  /// Gradient of an element's quality, which is this, by the position of its apex, as if the metric
  /// that judges it stayed what it is.
  Vector<3> gradient(std::size_t element, const Site<3>& apex, double quality) const {
    const Block& block = blocks_[element / lane_count];
    const std::size_t l = element % lane_count;
    const Vector<3> u = at(block.side, l), w = at(block.first, l) - (apex.position - origin_);
    const Metric<3> metric =
        corner_weight<2>(block.unit[l] * apex.scale) * apex.metric + tensor_at<3>(block.metric, l);
    const Vector<3> mu = product(metric, u), mw = product(metric, w);
    const double uu = dot(u, mu), uw = dot(u, mw), ww = dot(w, mw);
    return quality * ((2 / (uu + uw + ww)) * (mw + 0.5 * mu) -
                      (1 / (uu * ww - uw * uw)) * (uu * mw - uw * mu));
  }

 private:
  /// Edges opposite to the vertex, seen from where it is.
  struct Block {
    LanesOf<3> first, side;  // one end, and from there to the other
    LanesOf<3> turn;         // normals of the triangles as they are
    LanesOf<6> metric;       // mean_metric() of both ends
    Lanes unit;              // inverses of the larger scales of both ends
    QualityLanes quality;    // as the mesh has it
    QualityLanes counts;     // 1, or 0 where there is no element but a copy of another
  };

  static Vector<3> at(const LanesOf<3>& lanes, std::size_t l) {
    return {{lanes[0][l], lanes[1][l], lanes[2][l]}};
  }

  void fill(const Mesh<2, 3>& mesh, std::size_t b) {
    const auto elements = mesh.elements_of.of(vertex_);
    Block& block = blocks_[b];
    block.counts = first_lanes(elements.size() - b * lane_count);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const ElementId e = elements[std::min(b * lane_count + l, elements.size() - 1)];
      const Facet<2> ends = facet_opposite<2>(mesh.corners_of[e], vertex_);
      const Site<3>&p = mesh.site_of[ends[0]], &q = mesh.site_of[ends[1]];
      const Vector<3> first = p.position - origin_, side = q.position - p.position;
      const Vector<3> turn = cross(first, side);
      for (std::size_t i = 0; i < 3; ++i) {
        block.first[i][l] = first.x[i];
        block.side[i][l] = side.x[i];
        block.turn[i][l] = turn.x[i];
      }
      const Metric<3> metric = mean_metric<3>(std::array{&p, &q}).metric;
      for (std::size_t i = 0; i < 6; ++i) block.metric[i][l] = metric.m[i];
      block.unit[l] = 1 / std::max(p.scale, q.scale);
      block.quality[l] = mesh.quality_of[e];
    }
  }

  static QualityLanes judge(const Block& block, const Site<3>& apex, const Vector<3>& origin) {
    const Vector<3> offset = apex.position - origin;
    QualityLanes quality;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Vector<3> u = at(block.side, l), w = at(block.first, l) - offset;
      const double weight = corner_weight<2>(block.unit[l] * apex.scale);
      Metric<3> m;
      for (std::size_t i = 0; i < 6; ++i) m.m[i] = weight * apex.metric.m[i] + block.metric[i][l];
      const double uu = squared_length(m, u), ww = squared_length(m, w),
                   uw = 0.5 * (squared_length(m, u + w) - uu - ww);
      const double square = uu * ww - uw * uw;
      const double turn = dot(cross(w, u), at(block.turn, l));
      const double value = std::sqrt(3.0) * std::sqrt(std::max(square, 0.0)) / (uu + uw + ww);
      quality[l] = static_cast<float>(turn > 0 ? value : -1);
    }
    return quality;
  }
  QualityLanes judge(const Block& block, const Site<3>& apex) const {
    return judge(block, apex, origin_);
  }

  Instructions instructions_;
  VertexId vertex_;
  Vector<3> origin_;  // lanes are relative to it: less is lost by rounding
  std::size_t size_;
  Buffer<Block, 1> blocks_;
};

}  // namespace ductile::meshadapt
