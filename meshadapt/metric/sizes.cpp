#include "ductile/meshadapt/sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/boundary_surface.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/distance.hpp"
#include "mesh/indices.hpp"
#include "mesh/scale.hpp"
#include "mesh/wording.hpp"
#include "metric/entities_of.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

bool is_size(double size) { return size >= smallest_size && size <= largest_size; }

bool is_finite(const Vector<3>& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

Vector<3> in_space(const AnyMesh& mesh, std::size_t vertex) {
  Vector<3> position;
  for (int axis = 0; axis < mesh.dimension; ++axis)
    position[axis] = mesh.coordinates[vertex * static_cast<std::size_t>(mesh.dimension) +
                                      static_cast<std::size_t>(axis)];
  return position;
}

// ---- What makes sense ----

void expect_growth(const SizeGrowth& growth, double size) {
  const auto [grow, largest, distance] = growth;
  if (!(grow == 0 || (grow >= 1 && std::isfinite(grow))))
    throw InputError("expected a growth of 1 or more, or 0 for none, found " + number(grow));
  if (largest != 0 && !(largest >= size && largest <= largest_size))
    throw InputError("expected to grow to a size of " + number(size) + " or more, found " +
                     number(largest));
  if (!(distance >= 0 && std::isfinite(distance)))
    throw InputError("expected to grow over a distance above 0, found " + number(distance));
  if (distance > 0 && largest == 0)
    throw InputError("expected a largest size to grow to over the distance of " + number(distance));
}

void expect_place(const Ball& ball) {
  if (!is_finite(ball.centre) || !(ball.radius >= 0 && std::isfinite(ball.radius)))
    throw InputError("expected a centre and a radius of 0 or more, found a radius of " +
                     number(ball.radius));
}
void expect_place(const AxisBox& box) {
  for (int i = 0; i < 3; ++i)
    if (!(box.low[i] <= box.high[i]) || !is_finite(box.low) || !is_finite(box.high))
      throw InputError("expected a box from its lowest to its highest corner, found one from " +
                       number(box.low[i]) + " to " + number(box.high[i]) + " along axis " +
                       std::to_string(i));
}
void expect_points(const std::vector<Vector<3>>& points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_finite(points[i]))
      throw InputError("points[" + std::to_string(i) + "]: expected finite coordinates");
}
void expect_place(const Polyline& line) {
  if (line.points.empty()) throw InputError("expected points, found none");
  expect_points(line.points);
}
void expect_place(const TriangleSurface& surface) {
  if (surface.triangles.empty()) throw InputError("expected triangles, found none");
  expect_points(surface.points);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    for (const std::uint32_t corner : surface.triangles[i])
      if (corner >= surface.points.size())
        throw InputError("triangles[" + std::to_string(i) + "]: expected points below " +
                         std::to_string(surface.points.size()) + ", found " +
                         std::to_string(corner));
}
void expect_place(const Referenced& entities) {
  if (entities.dimension < 0 || entities.dimension > 3)
    throw InputError("expected entities of a dimension from 0 to 3, found " +
                     std::to_string(entities.dimension));
}
void expect_place(const Named&) {}

void expect_source(const SizeSource& source) {
  if (!is_size(source.size))
    throw InputError("expected a size from 1e-75 to 1e75, found " + number(source.size));
  expect_growth(source.growth, source.size);
  std::visit([](const auto& place) { expect_place(place); }, source.place);
}

// ---- Triangles that distances are measured to; of segments and points corners are the same ----

using Triangle = std::array<Vector<3>, 3>;

std::vector<Triangle> triangles_of(const Polyline& line) {
  const auto& points = line.points;
  std::vector<Triangle> triangles;
  if (points.size() == 1) triangles.push_back({points[0], points[0], points[0]});
  for (std::size_t i = 1; i < points.size(); ++i)
    triangles.push_back({points[i - 1], points[i], points[i - 1]});
  return triangles;
}

std::vector<Triangle> triangles_of(const TriangleSurface& surface) {
  std::vector<Triangle> triangles;
  triangles.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles)
    triangles.push_back({surface.points[a], surface.points[b], surface.points[c]});
  return triangles;
}

Triangle triangle_of(const AnyMesh& mesh, std::span<const std::uint32_t> corners) {
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i)
    triangle[i] = in_space(mesh, corners[i < corners.size() ? i : 0]);
  return triangle;
}

std::vector<Triangle> triangles_of(const AnyMesh& mesh, const EntityList& list) {
  std::vector<Triangle> triangles;
  triangles.reserve(list.corners.size());
  for (const auto& corners : list.corners)
    triangles.push_back(
        triangle_of(mesh, std::span(corners).first(static_cast<std::size_t>(list.dimension) + 1)));
  return triangles;
}

/// The facets of elements of a reference with none of them on the other side.
template <int Dim>
std::vector<Triangle> rim_of(const AdjacentMesh& mesh, std::int32_t reference) {
  expect_corners<Dim>(mesh.executor(), mesh.mesh());
  const auto& reference_of = elements_in<Dim>(mesh.mesh()).reference;
  const std::vector<std::uint32_t> region_of(reference_of.begin(), reference_of.end());
  std::vector<Triangle> triangles;
  for (const auto& side : sides_of<Dim>(mesh.executor(), mesh.adjacency<Dim>(), region_of))
    if (side.region == static_cast<std::uint32_t>(reference))
      triangles.push_back(triangle_of(mesh.mesh(), side.corners));
  return triangles;
}

// ---- Evaluation ----

bool grows(const SizeGrowth& growth) { return growth.grow > 0 || growth.distance > 0; }

/// A size as a function of the distance.
struct GrowingSize {
  explicit GrowingSize(const SizeSource& source) : size(source.size) {
    const auto [factor, most, distance] = source.growth;
    if (!grows(source.growth)) return;
    slope = distance > 0 ? (most - size) / distance : std::log(factor);
    if (most > 0) largest = most;
  }

  double at(double distance) const {
    if (slope == unlimited) return distance < here() ? size : unlimited;
    return slope > 0 ? std::min(largest, size + slope * distance) : size;
  }
  /// From this distance on it is no finer than another size.
  double reach(double other) const {
    if (slope == unlimited) return here();
    return slope > 0 ? (other - size) / slope : unlimited;
  }
  /// A distance below this counts as 0; rounding may be the reason for it.
  double here() const { return 1e-9 * size; }

  double size, slope = unlimited, largest = unlimited;
};

class Evaluation {
 public:
  Evaluation(const Executor& executor, const AnyMesh& mesh)
      : executor_(executor), mesh_(mesh), size_of_(mesh.vertex_count(), unlimited) {}

  /// Regions come first, because they take the place of the size elsewhere.
  std::vector<double> run(const Sizes& sizes) {
    each_source(sizes, [&](const SizeSource& source) { take_regions(source); });
    const double diagonal = size_of_.empty() ? 1 : diagonal_of(mesh_);
    const double elsewhere = sizes.elsewhere > 0 ? sizes.elsewhere
                             : is_size(diagonal) ? diagonal
                                                 : largest_size;
    for (double& size : size_of_)
      if (size == unlimited) size = elsewhere;
    each_source(sizes, [&](const SizeSource& source) {
      std::visit([&](const auto& place) { refine(source, place); }, source.place);
    });
    const auto [smallest, largest, anisotropy] = sizes.bounds;
    for (double& size : size_of_) {
      if (largest > 0) size = std::min(size, largest);
      size = std::clamp(std::max(size, smallest), smallest_size, largest_size);
    }
    return std::move(size_of_);
  }

 private:
  using References = std::set<std::pair<int, std::int32_t>>;  // dimension, reference

  References references(const SizePlace& place) const {
    if (const auto* entities = std::get_if<Referenced>(&place))
      return {{entities->dimension, entities->reference}};
    if (const auto* named = std::get_if<Named>(&place)) return references_named(mesh_, named->name);
    return {};
  }

  EntityList entities(int dimension, std::int32_t reference) const {
    EntityList list = entities_of(mesh_, dimension, reference);
    if (list.corners.empty())
      throw InputError("expected " + std::string(entities_word(dimension)) + " of reference " +
                       std::to_string(reference) + " in " + name_of(mesh_) + ", found none");
    return list;
  }

  void take_regions(const SizeSource& source) {
    for (const auto& [dimension, reference] : references(source.place))
      if (dimension == mesh_.dimension) take_at(entities(dimension, reference), source.size);
  }

  void take_at(const EntityList& list, double size) {
    for (const auto& corners : list.corners)
      for (std::size_t c = 0; c <= static_cast<std::size_t>(list.dimension); ++c)
        size_of_[corners[c]] = std::min(size_of_[corners[c]], size);
  }

  void refine(const SizeSource& source, const Ball& ball) {
    grow(source, [&](const Vector<3>& at, double) {
      return std::max(0.0, norm(at - ball.centre) - ball.radius);
    });
  }
  void refine(const SizeSource& source, const AxisBox& box) {
    grow(source, [&](const Vector<3>& at, double) {
      Vector<3> beyond;
      for (int i = 0; i < mesh_.dimension; ++i)
        beyond[i] = std::max({box.low[i] - at[i], at[i] - box.high[i], 0.0});
      return norm(beyond);
    });
  }
  void refine(const SizeSource& source, const Polyline& line) {
    refine(source, triangles_of(line));
  }
  void refine(const SizeSource& source, const TriangleSurface& surface) {
    refine(source, triangles_of(surface));
  }
  void refine(const SizeSource& source, const std::vector<Triangle>& triangles) {
    const BoxHierarchy<3> boxes(executor_, triangles.size(),
                                [&](std::size_t i) { return box_around(triangles[i]); });
    grow(source, [&](const Vector<3>& at, double most) {
      double square = most * most;
      boxes.visit_near(at, square, [&](std::size_t place) {
        const Triangle& t = triangles[boxes.order()[place]];
        const bool is_segment = t[2] == t[0];
        const Vector<3> off =
            (is_segment ? closest_point(std::array{t[0], t[1]}, at) : closest_point(t, at)) - at;
        square = std::min(square, dot(off, off));
      });
      return std::min(most, std::sqrt(square));
    });
  }
  void refine(const SizeSource& source, const Referenced&) { refine_entities(source); }
  void refine(const SizeSource& source, const Named&) { refine_entities(source); }

  void refine_entities(const SizeSource& source) {
    for (const auto& [dimension, reference] : references(source.place)) {
      if (dimension < mesh_.dimension) {
        const EntityList list = entities(dimension, reference);
        take_at(list, source.size);
        if (grows(source.growth)) refine(source, triangles_of(mesh_, list));
      } else if (grows(source.growth)) {
        refine(source, mesh_.dimension == 2 ? rim_of<2>(adjacent_, reference)
                                            : rim_of<3>(adjacent_, reference));
      }
    }
  }

  /// Makes sizes finer; distance(position, most) may say `most` where it is farther.
  template <class Distance>
  void grow(const SizeSource& source, Distance&& distance) {
    const GrowingSize growing(source);
    runtime::parallel_for(executor_, size_of_.size(), [&](std::size_t v) {
      double& size = size_of_[v];
      if (!(source.size < size)) return;
      size = std::min(size, growing.largest);
      size = std::min(size, growing.at(distance(in_space(mesh_, v), growing.reach(size))));
    });
  }

  const Executor& executor_;
  const AnyMesh& mesh_;
  std::vector<double> size_of_;              // [vertex]
  AdjacentMesh adjacent_{executor_, mesh_};  // asked when a region grows
};

}  // namespace

AnyField size_field(const Executor& executor, const AnyMesh& mesh, const Sizes& sizes) {
  expect_coordinates(mesh);
  expect_references(mesh);
  if (sizes.elsewhere != 0 && !is_size(sizes.elsewhere))
    throw InputError("elsewhere: expected a size from 1e-75 to 1e75, or 0 for none, found " +
                     number(sizes.elsewhere));
  expect_bounds(sizes.bounds);
  each_source(sizes, expect_source);
  Evaluation evaluation(executor, mesh);
  return scalar_field(mesh.dimension, evaluation.run(sizes), mesh.name);
}

}  // namespace ductile::meshadapt
