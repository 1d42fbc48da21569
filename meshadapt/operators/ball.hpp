/// @file
/// Ball: the elements around a vertex as bases under an apex that may move (base.hpp), eight side
/// by side: loops over lanes are such that the compiler evaluates several elements at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include "operators/base.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

inline constexpr std::size_t lane_count = 8;
using Lanes = std::array<double, lane_count>;  ///< one number of each of so many elements
template <int Size>
using LanesOf = std::array<Lanes, Size>;  ///< a vector or tensor of each

/// What Base holds, of eight elements. Where shapes may be doubtful the metrics of all corners of
/// the facets are kept, else that of the densest; it comes first.
template <int Dim>
struct BaseLanes {
  static constexpr int size = Metric<Dim>::size;
  static constexpr std::size_t judges = doubtful_shape<Dim> > 0 ? Dim : 1;

  LanesOf<Dim> normal, centre;
  LanesOf<size> spread;
  std::array<LanesOf<size>, judges> metric;
  std::array<Lanes, judges> squares;  // by each of the metrics
  Lanes density;                      // of the densest corner
  Lanes counts;                       // 1, or 0 where there is no element but a copy of another
};

template <int Dim>
class Ball {
 public:
  struct Score {
    double worst = 0, sum = 0;
  };
  /// One of each element, in the order of the vertex's list.
  using Shapes = Buffer<float, Dim == 2 ? 8 : 32>;

  Ball(const Mesh<Dim>& mesh, VertexId vertex)
      : origin_(mesh.site_of[vertex].position), size_(mesh.elements_of.of(vertex).size()) {
    const auto elements = mesh.elements_of.of(vertex);
    blocks_.resize((size_ + lane_count - 1) / lane_count, boost::container::default_init);
    for (std::size_t b = 0; b < blocks_.size(); ++b) fill(mesh, vertex, elements, b);
  }

  std::size_t size() const { return size_; }

  /// Worst and sum of all shapes with this apex; just a worst of -1 if one is below the bound, has
  /// no positive volume or is not a number.
  Score score(const Site<Dim>& apex, double bound) const {
    double worst = 1;
    Lanes sum{};
    for (const Block& block : blocks_) {
      const Lanes shape = shapes_in(block, apex);
      worst = std::min(worst, least(shape));
      if (!(worst > 0) || worst < bound) return {-1, 0};
      for (std::size_t l = 0; l < lane_count; ++l) sum[l] += block.counts[l] * shape[l];
    }
    const double all = total(sum);
    return all > 0 ? Score{worst, all} : Score{-1, 0};  // least() does not see what is no number
  }

  /// Calls visit(i, shape) for each element.
  void visit_shapes(const Site<Dim>& apex, auto&& visit) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Lanes shape = shapes_in(blocks_[b], apex);
      const std::size_t begin = b * lane_count, end = std::min(size_, begin + lane_count);
      for (std::size_t i = begin; i < end; ++i) visit(i, shape[i - begin]);
    }
  }

  Shapes shapes(const Site<Dim>& apex) const {
    Shapes result;
    visit_shapes(apex,
                 [&](std::size_t, double shape) { result.push_back(static_cast<float>(shape)); });
    return result;
  }

  /// Every element pulls its apex to where it would be regular over its base, or half-way from
  /// there to where its edges have unit length, by this metric; bad elements pull harder,
  /// by the inverse of shape_of(i). The mean pull, from where the vertex is.
  Vector<Dim> mean_pull(const Metric<Dim>& metric, auto&& shape_of) const {
    const Metric<Dim> dual = inverse(metric);
    LanesOf<Dim> sum{};
    Lanes weights{};
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      Lanes weight{};
      const std::size_t begin = b * lane_count, end = std::min(size_, begin + lane_count);
      for (std::size_t i = begin; i < end; ++i)
        weight[i - begin] = 1 / std::max(0.01, static_cast<double>(shape_of(i)));
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double square = contraction(metric, at_tensor(block.spread, l)) / (2 * Dim - 3);
        // the geometric mean of the facet's size and 1
        const double height = std::sqrt(std::sqrt(square)) * std::sqrt(Dim == 2 ? 0.75 : 2.0 / 3);
        const Vector<Dim> normal = at(block.normal, l), up = product(dual, normal);
        const double stretch = height / std::sqrt(dot(normal, up));
        const Vector<Dim> place = at(block.centre, l) + stretch * up;
        for (std::size_t i = 0; i < Dim; ++i) sum[i][l] += weight[l] * place.x[i];
        weights[l] += weight[l];
      }
    }
    Vector<Dim> pull;
    for (std::size_t i = 0; i < Dim; ++i) pull.x[i] = total(sum[i]) / total(weights);
    return pull;
  }

  /// Gradient of an element's shape, which is this, by the position of its apex, in the metric that
  /// judges it now.
  Vector<Dim> gradient(std::size_t element, const Site<Dim>& apex, double shape) const {
    const Block& block = blocks_[element / lane_count];
    const std::size_t l = element % lane_count;
    const Vector<Dim> up = apex.position - origin_ - at(block.centre, l);
    const auto by = [&](const Metric<Dim>& metric) {
      return squares_over(contraction(metric, at_tensor(block.spread, l)), metric, up);
    };
    Metric<Dim> judge =
        apex.density > block.density[l] ? apex.metric : at_tensor(block.metric[0], l);
    double squares = by(judge);
    if (shape <= doubtful_shape<Dim>) {
      const auto ask = [&](const Metric<Dim>& metric) {
        const double here = by(metric);
        if (here > squares) judge = metric;
        squares = std::max(squares, here);
      };
      ask(apex.metric);
      for (const auto& metric : block.metric) ask(at_tensor(metric, l));
    }
    const Vector<Dim> normal = at(block.normal, l);
    constexpr double power = Dim == 2 ? 1.0 : 1.5;
    return shape *
           ((1 / dot(normal, up)) * normal - (2 * power * Dim / squares) * product(judge, up));
  }

 private:
  using Block = BaseLanes<Dim>;

  static Vector<Dim> at(const LanesOf<Dim>& lanes, std::size_t l) {
    Vector<Dim> v;
    for (std::size_t i = 0; i < Dim; ++i) v.x[i] = lanes[i][l];
    return v;
  }
  static Metric<Dim> at_tensor(const LanesOf<Metric<Dim>::size>& lanes, std::size_t l) {
    Metric<Dim> m;
    for (std::size_t i = 0; i < m.m.size(); ++i) m.m[i] = lanes[i][l];
    return m;
  }
  static double folded(Lanes lanes, auto&& join) {
    for (std::size_t half = lane_count / 2; half > 0; half /= 2)
      for (std::size_t l = 0; l < half; ++l) lanes[l] = join(lanes[l], lanes[l + half]);
    return lanes[0];
  }
  static double total(const Lanes& lanes) { return folded(lanes, std::plus<>()); }
  static double least(const Lanes& lanes) {
    return folded(lanes, [](double a, double b) { return a < b ? a : b; });
  }

  /// shape_over() of each.
  Lanes shapes_in(const Block& block, const Site<Dim>& apex) const {
    const Vector<Dim> offset = apex.position - origin_;
    Lanes shape;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Vector<Dim> up = offset - at(block.centre, l);
      const double determinant = dot(at(block.normal, l), up);
      const double by_apex =
          squares_over(contraction(apex.metric, at_tensor(block.spread, l)), apex.metric, up);
      const double by_judge = squares_over(block.squares[0][l], at_tensor(block.metric[0], l), up);
      const bool apex_judges = apex.density > block.density[l];
      const double volume = (apex_judges ? apex.density : block.density[l]) * determinant;
      double value = shape_from<Dim>(volume, apex_judges ? by_apex : by_judge);
      if constexpr (Block::judges > 1) {
        double most = by_apex > by_judge ? by_apex : by_judge;
        for (std::size_t j = 1; j < Block::judges; ++j) {
          const double by_other =
              squares_over(block.squares[j][l], at_tensor(block.metric[j], l), up);
          most = by_other > most ? by_other : most;
        }
        const double strict = shape_from<Dim>(volume, most);
        value = value > doubtful_shape<Dim> ? value : strict;
      }
      shape[l] = value;
    }
    return shape;
  }

  void fill(const Mesh<Dim>& mesh, VertexId vertex, std::span<const ElementId> elements,
            std::size_t b) {
    Block& block = blocks_[b];
    std::array<LanesOf<Dim>, Dim> corner;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t i = b * lane_count + l;
      block.counts[l] = i < elements.size() ? 1 : 0;
      const Corners<Dim>& corners = mesh.corners_of[elements[std::min(i, elements.size() - 1)]];
      const Facet<Dim> facet = facet_of<Dim>(corners, corner_of(corners, vertex));
      std::size_t densest = 0;
      for (std::size_t k = 0; k < Dim; ++k) {
        const Site<Dim>& site = mesh.site_of[facet[k]];
        for (std::size_t j = 0; j < Dim; ++j) corner[k][j][l] = site.position.x[j] - origin_.x[j];
        if (site.density > mesh.site_of[facet[densest]].density) densest = k;
      }
      block.density[l] = mesh.site_of[facet[densest]].density;
      for (std::size_t j = 0; j < Block::judges; ++j) {
        const Metric<Dim>& metric = mesh.site_of[facet[(densest + j) % Dim]].metric;
        for (std::size_t k = 0; k < metric.m.size(); ++k) block.metric[j][k][l] = metric.m[k];
      }
    }
    raise(block, corner);
  }

  /// What follows from the corners of the facets.
  static void raise(Block& block, const std::array<LanesOf<Dim>, Dim>& corner) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Vector<Dim> first = at(corner[0], l), side = at(corner[1], l) - first;
      Vector<Dim> normal, centre = first + at(corner[1], l);
      Metric<Dim> spread;
      if constexpr (Dim == 2) {
        normal = {{-side[1], side[0]}};
        spread = spread_of(side);
      } else {
        const Vector<Dim> other = at(corner[2], l) - first;
        normal = cross(other, side);
        spread = spread_of(side, other);
        centre += at(corner[2], l);
      }
      centre *= 1.0 / Dim;
      for (std::size_t i = 0; i < Dim; ++i) block.normal[i][l] = normal.x[i];
      for (std::size_t i = 0; i < Dim; ++i) block.centre[i][l] = centre.x[i];
      for (std::size_t i = 0; i < spread.m.size(); ++i) block.spread[i][l] = spread.m[i];
      for (std::size_t j = 0; j < Block::judges; ++j)
        block.squares[j][l] = contraction(at_tensor(block.metric[j], l), spread);
    }
  }

  Vector<Dim> origin_;  // lanes are relative to it: less is lost by rounding
  std::size_t size_;
  Buffer<Block, Dim == 2 ? 1 : 4> blocks_;
};

}  // namespace ductile::meshadapt
