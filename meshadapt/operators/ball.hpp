/// @file
/// VertexBall: the elements around a vertex as bases under an apex that may move (base.hpp), eight
/// side by side (lanes.hpp). Determinants and sums of squared lengths are double, as terms may
/// cancel in them; what follows from these is float, like the qualities that a mesh keeps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/determinant.hpp"
#include "core/lanes.hpp"
#include "operators/base.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

/// Facets opposite to a vertex, as if they were bases of eight elements.
template <int Dim>
struct BaseLanes {
  static constexpr int size = Metric<Dim>::size;

  LanesOf<Dim> normal, centre;
  LanesOf<size> spread;
  LanesOf<size> metric;  // the mean_metric() of their corners
  Lanes scale;           // of that
  Lanes unit;            // inverses of their corners' largest scales
  QualityLanes quality;  // as the mesh has it
  QualityLanes counts;   // 1, or 0 where there is no element but a copy of another
};

/// The qualities of the elements around a vertex, in the order of its list; of more than `most`,
/// which is rare, the first. Copied as a whole, as it is small.
template <int Dim>
struct BallQualities {
  static constexpr std::size_t blocks = Dim == 2 ? 1 : 5, most = blocks * lane_count;
  std::array<QualityLanes, blocks> lanes{};

  float operator[](std::size_t i) const { return lanes[i / lane_count][i % lane_count]; }
  friend bool operator==(const BallQualities&, const BallQualities&) = default;
};

template <int Dim, int Space = Dim>
class VertexBall {
 public:
  struct Score {
    double worst = 0, sum = 0;
    double volume = 0;  ///< the least, times 2 in 2D or 6 in 3D, as rounding leaves it
  };
  using Qualities = BallQualities<Dim>;

  VertexBall(const Mesh<Dim>& mesh, VertexId vertex)
      : instructions_(mesh.instructions),
        vertex_(vertex),
        origin_(mesh.site_of[vertex].position),
        size_(mesh.elements_of.of(vertex).size()) {
    blocks_.resize((size_ + lane_count - 1) / lane_count, boost::container::default_init);
    run_with(instructions_, [&] {
      for (std::size_t b = 0; b < blocks_.size(); ++b) fill(mesh, vertex, b);
    });
  }

  VertexId vertex() const { return vertex_; }
  std::size_t size() const { return size_; }

  /// Worst and sum of all qualities as the mesh has them.
  Score present() const {
    float worst = 1;
    QualityLanes sum{};
    for (const Block& block : blocks_) {
      worst = std::min(worst, least(block.quality));
      for (std::size_t l = 0; l < lane_count; ++l) sum[l] += block.counts[l] * block.quality[l];
    }
    return {worst, total(sum)};
  }

  /// Worst and sum of all qualities with this apex; just a worst of -1 if one is below the bound,
  /// has no positive volume or is not a number.
  Score score(const Site<Dim>& apex, double bound) const {
    Qualities qualities;
    return score(apex, bound, qualities);
  }
  /// The same; sets the qualities, too.
  Score score(const Site<Dim>& apex, double bound, Qualities& qualities) const {
    return run_with(instructions_, [&] { return score_of_all(apex, bound, qualities); });
  }

  /// Is it certain that volumes are positive if the least of them comes out as this with the vertex
  /// here? Rounding changes the determinants of judge() by no more than 28 in 2D, or 300 in 3D,
  /// times epsilon times the product of the largest coordinates along each axis.
  bool is_certain(double volume, const Vector<Dim>& position) const {
    double scale = (Dim == 2 ? 64 : 512) * std::numeric_limits<double>::epsilon();
    for (int i = 0; i < Dim; ++i) scale *= std::max(reach(i), std::abs(position[i] - origin_[i]));
    return volume > scale;
  }

  /// Calls visit(i, quality) for each element.
  void visit_qualities(const Site<Dim>& apex, auto&& visit) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const QualityLanes quality =
          run_with(instructions_, [&] { return judge(blocks_[b], apex).quality; });
      const std::size_t begin = b * lane_count, end = std::min(size_, begin + lane_count);
      for (std::size_t i = begin; i < end; ++i) visit(i, static_cast<double>(quality[i - begin]));
    }
  }

  /// Every element pulls its apex to where it would be regular over its base, or half-way from
  /// there to where its edges have unit length, by the metric of this site; bad elements pull
  /// harder, by the inverse of their qualities. The mean pull, from where the vertex is. As it is
  /// no more than a guess, roots are taken of numbers without a unit, in single precision.
  Vector<Dim> mean_pull(const Site<Dim>& site) const {
    return run_with(instructions_, [&] { return mean_pull_of_all(site); });
  }

  /// Gradient of an element's quality, which is this, by the position of its apex, as if the metric
  /// that judges it stayed what it is.
  Vector<Dim> gradient(std::size_t element, const Site<Dim>& apex, double quality) const {
    const Block& block = blocks_[element / lane_count];
    const std::size_t l = element % lane_count;
    const Vector<Dim> up = apex.position - origin_ - at(block.centre, l);
    const Metric<Dim> all = all_edges(tensor_at<Dim>(block.spread, l), up);
    const Metric<Dim> metric = corner_weight<Dim>(block.unit[l] * apex.scale) * apex.metric +
                               tensor_at<Dim>(block.metric, l);
    const double squares = contraction(metric, all);
    const Vector<Dim> normal = at(block.normal, l);
    constexpr double power = Dim == 2 ? 1.0 : 1.5;
    return quality *
           ((1 / dot(normal, up)) * normal - (2 * power * Dim / squares) * product(metric, up));
  }

 private:
  using Block = BaseLanes<Dim>;

  static Vector<Dim> at(const LanesOf<Dim>& lanes, std::size_t l) {
    Vector<Dim> v;
    for (std::size_t i = 0; i < Dim; ++i) v.x[i] = lanes[i][l];
    return v;
  }

  /// By what to multiply dual * normal to get as far up from the centre of a facet, of the mean
  /// squared edge length `square`, as the apex of a regular element, or half-way between that and
  /// where it is 1 high. In 2D the normal is as long as the edge.
  static double height_over_normal(double square, const Vector<Dim>& normal,
                                   const Metric<Dim>& dual, double density) {
    const float side = std::sqrt(static_cast<float>(square));
    if constexpr (Dim == 2) return density * (std::sqrt(0.75F) / std::sqrt(side));
    const double area2 = density * density * squared_length(dual, normal);
    return density * std::sqrt(2.0F / 3 * side / static_cast<float>(area2));
  }

  /// score() and mean_pull(), with the instructions of their caller.
  Score score_of_all(const Site<Dim>& apex, double bound, Qualities& qualities) const {
    if (!(apex.scale > 0)) return {-1, 0};
    float worst = 1;
    double volume = std::numeric_limits<double>::infinity();
    QualityLanes sum{};
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Judged judged = judge(blocks_[b], apex);
      worst = std::min(worst, least(judged.quality));
      volume = std::min(volume, least(judged.determinant));
      if (!(worst > 0) || worst < bound) return {-1, 0};
      if (b < Qualities::blocks) qualities.lanes[b] = judged.quality;
      for (std::size_t l = 0; l < lane_count; ++l)
        sum[l] += blocks_[b].counts[l] * judged.quality[l];
    }
    const float all = total(sum);
    if (!(all > 0) || std::isinf(all)) return {-1, 0};  // least() may overlook what is no number
    return {worst, all, volume};
  }

  Vector<Dim> mean_pull_of_all(const Site<Dim>& site) const {
    const Metric<Dim> dual = inverse(site.metric);
    const double density = metric_volume<Dim>(1, site.scale);
    LanesOf<Dim> centres{}, normals{};
    Lanes weights{};
    for (const Block& block : blocks_)
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double weight = block.counts[l] / std::max(0.01F, block.quality[l]);
        // the geometric mean of the facet's size and 1
        const double square =
            contraction(site.metric, tensor_at<Dim>(block.spread, l)) / (2 * Dim - 3);
        const Vector<Dim> normal = at(block.normal, l), centre = at(block.centre, l);
        // place = centre + stretch * dual * normal
        const double stretch = weight * height_over_normal(square, normal, dual, density);
        for (std::size_t i = 0; i < Dim; ++i) {
          centres[i][l] += weight * centre.x[i];
          normals[i][l] += stretch * normal.x[i];
        }
        weights[l] += weight;
      }
    Vector<Dim> centre, normal;
    for (std::size_t i = 0; i < Dim; ++i) centre.x[i] = total(centres[i]);
    for (std::size_t i = 0; i < Dim; ++i) normal.x[i] = total(normals[i]);
    return (1 / total(weights)) * (centre + product(dual, normal));
  }

  struct Judged {
    Lanes determinant;
    QualityLanes quality;
  };

  /// quality() of each, up to rounding.
  Judged judge(const Block& block, const Site<Dim>& apex) const {
    const Vector<Dim> offset = apex.position - origin_;
    Judged judged;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Vector<Dim> up = offset - at(block.centre, l);
      const double determinant = dot(at(block.normal, l), up);
      const Metric<Dim> all = all_edges(tensor_at<Dim>(block.spread, l), up);
      const double weight = corner_weight<Dim>(block.unit[l] * apex.scale);
      const double squares = weight * contraction(apex.metric, all) +
                             contraction(tensor_at<Dim>(block.metric, l), all);
      const double scale = weight * apex.scale + block.scale[l];
      const double volume = metric_volume<Dim>(determinant, scale);
      judged.determinant[l] = determinant;
      judged.quality[l] =
          quality_from<Dim>(static_cast<float>(volume), static_cast<float>(squares));
    }
    return judged;
  }

  /// The spread_of() all edges of an element, from that of its base: see squares_over(). Written
  /// out, as loops in a loop over lanes keep it from being vectorised.
  static Metric<Dim> all_edges(const Metric<Dim>& spread, const Vector<Dim>& up) {
    constexpr double base = (Dim + 1.0) / Dim;
    const double x = Dim * up[0], y = Dim * up[1];
    Metric<Dim> all;
    all.m[0] = base * spread.m[0] + x * up[0];
    all.m[1] = base * spread.m[1] + 2 * x * up[1];
    all.m[2] = base * spread.m[2] + y * up[1];
    if constexpr (Dim == 3) {
      all.m[3] = base * spread.m[3] + 2 * x * up[2];
      all.m[4] = base * spread.m[4] + 2 * y * up[2];
      all.m[5] = base * spread.m[5] + Dim * up[2] * up[2];
    }
    return all;
  }

  /// No corner is farther from where the vertex is along this axis; from the centre of its facet it
  /// is no farther than the facet is wide.
  double reach(int axis) const {
    const auto i = static_cast<std::size_t>(axis);
    Lanes centre{}, width2{};
    for (const Block& block : blocks_)
      for (std::size_t l = 0; l < lane_count; ++l) {
        centre[l] = std::max(centre[l], std::abs(block.centre[i][l]));
        width2[l] = std::max(width2[l], block.spread[i * (i + 3) / 2][l]);
      }
    return greatest(centre) + std::sqrt(greatest(width2));
  }

  /// Reads eight elements. Where to find them is looked up one by one, all else side by side.
  void fill(const Mesh<Dim>& mesh, VertexId vertex, std::size_t b) {
    const auto elements = mesh.elements_of.of(vertex);
    Block& block = blocks_[b];
    block.counts = first_lanes(elements.size() - b * lane_count);
    std::array<SiteOfLane, Dim> site;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t i = b * lane_count + l;
      const ElementId e = elements[std::min(i, elements.size() - 1)];
      block.quality[l] = mesh.quality_of[e];
      const Facet<Dim> facet = facet_opposite<Dim>(mesh.corners_of[e], vertex);
      for (std::size_t k = 0; k < Dim; ++k) site[k][l] = &mesh.site_of[facet[k]];
    }
    std::array<LanesOf<Dim>, Dim> corner;
    for (std::size_t k = 0; k < Dim; ++k) read_position(site[k], corner[k]);
    read_metrics(site, block);
    raise(block, corner);
  }

  using SiteOfLane = std::array<const Site<Dim>*, lane_count>;
  static_assert(sizeof(Site<Dim>) == (Dim + Block::size + 1) * sizeof(double));

  [[gnu::always_inline]] static void read_position(const SiteOfLane& site, LanesOf<Dim>& position) {
    transpose(site, 0, {&position[0], &position[1], Dim == 3 ? &position[Dim - 1] : nullptr});
  }
  [[gnu::always_inline]] static void read_metric(const SiteOfLane& site,
                                                 LanesOf<Block::size>& metric, Lanes& scale) {
    if constexpr (Dim == 2) {
      transpose(site, Dim, {&metric[0], &metric[1], &metric[2], &scale});
    } else {
      transpose(site, Dim, {&metric[0], &metric[1], &metric[2], &metric[3]});
      transpose(site, Dim + 3, {nullptr, &metric[4], &metric[5], &scale});
    }
  }

  /// mean_metric() of the corners of each facet. Written out, as loops in a loop over lanes keep it
  /// from being vectorised.
  [[gnu::always_inline]] static void read_metrics(const std::array<SiteOfLane, Dim>& site,
                                                  Block& block) {
    std::array<LanesOf<Block::size>, Dim> metric;
    std::array<Lanes, Dim> scale, weight;
    for (std::size_t k = 0; k < Dim; ++k) read_metric(site[k], metric[k], scale[k]);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double most = std::max(scale[0][l], scale[1][l]);
      block.unit[l] = 1 / (Dim == 2 ? most : std::max(most, scale[Dim - 1][l]));
    }
    for (std::size_t k = 0; k < Dim; ++k)
      for (std::size_t l = 0; l < lane_count; ++l)
        weight[k][l] = corner_weight<Dim>(block.unit[l] * scale[k][l]);
    const auto mean_of = [&](const auto& values, Lanes& mean) {
      for (std::size_t l = 0; l < lane_count; ++l)
        mean[l] = weight[0][l] * values(0)[l] + weight[1][l] * values(1)[l];
      if constexpr (Dim == 3)
        for (std::size_t l = 0; l < lane_count; ++l) mean[l] += weight[2][l] * values(2)[l];
    };
    mean_of([&](std::size_t k) -> const Lanes& { return scale[k]; }, block.scale);
    for (std::size_t i = 0; i < block.metric.size(); ++i)
      mean_of([&](std::size_t k) -> const Lanes& { return metric[k][i]; }, block.metric[i]);
  }

  /// Computes what depends on the corners of the facets.
  void raise(Block& block, const std::array<LanesOf<Dim>, Dim>& corner) const {
    const Vector<Dim> origin = origin_;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Vector<Dim> first = at(corner[0], l) - origin, second = at(corner[1], l) - origin;
      const Vector<Dim> side = second - first;
      Vector<Dim> normal, centre = first + second;
      Metric<Dim> spread;
      if constexpr (Dim == 2) {
        normal = {{-side[1], side[0]}};
        spread = spread_of(side);
      } else {
        const Vector<Dim> third = at(corner[2], l) - origin, other = third - first;
        normal = cross(other, side);
        spread = spread_of(side, other);
        centre += third;
      }
      centre *= 1.0 / Dim;
      for (std::size_t i = 0; i < Dim; ++i) block.normal[i][l] = normal.x[i];
      for (std::size_t i = 0; i < Dim; ++i) block.centre[i][l] = centre.x[i];
      for (std::size_t i = 0; i < spread.m.size(); ++i) block.spread[i][l] = spread.m[i];
    }
  }

  Instructions instructions_;
  VertexId vertex_;
  Vector<Dim> origin_;  // lanes are relative to it: less is lost by rounding
  std::size_t size_;
  Buffer<Block, Dim == 2 ? 1 : 4> blocks_;
};

}  // namespace ductile::meshadapt
