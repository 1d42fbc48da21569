/// @file
/// Metrics, tensors and origins over a motion: directions turn with the mesh, and each entity knows
/// the one that it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/move.hpp"
#include "move/rigid_motion.hpp"
#include "move_support.hpp"
#include "support/broken_input.hpp"

namespace ductile::meshadapt::move_test {
namespace {

using test::Random;
using test::uniform;
using Place = NamedField::Place;

template <class Dimension>
class MoveAlong : public testing::Test {};
TYPED_TEST_SUITE(MoveAlong, test::Dimensions, );

template <int Dim>
Rotation<Dim> random_rotation(Random& random) {
  Rotation<Dim> rotation{uniform(random, 0.3, 1.5), {{0, 0, 1}}};
  if (Dim == 3) {
    for (int i = 0; i < 3; ++i) rotation.axis[i] = uniform(random, -1, 1);
    rotation.axis *= 1 / norm(rotation.axis);
  }
  return rotation;
}

template <int Dim>
Motion<Dim> turn_by(const Rotation<Dim>& rotation) {
  return [=](const Vector<Dim>& p) { return all<Dim>(0.5) + rotation.turned(p - all<Dim>(0.5)); };
}

/// Sizes h along y and 2.5 h along the other axes, turned.
template <int Dim>
Metric<Dim> stretched(double h, const Rotation<Dim>& rotation) {
  Metric<Dim> metric = isotropic<Dim>(2.5 * h);
  metric.m[2] = 1 / (h * h);
  return rotation.turned(metric);
}

template <int Dim>
AnyField uniform_metric(const Executor& executor, const AnyMesh& mesh, const Metric<Dim>& metric) {
  return symmetric_field(executor, std::vector<Metric<Dim>>(mesh.vertex_count(), metric), "metric");
}

template <int Dim>
double difference(const Metric<Dim>& a, const Metric<Dim>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.m.size(); ++i)
    largest = std::max(largest, std::abs(a.m[i] - b.m[i]));
  return largest / std::abs(b.m[0]);
}

/// Corners of elements of bodies.
template <int Dim>
std::vector<std::uint8_t> in_body(const AnyMesh& mesh) {
  std::vector<std::uint8_t> marks(mesh.vertex_count(), 0);
  const auto& cells = elements_in<Dim>(mesh);
  for (std::size_t e = 0; e < cells.size(); ++e)
    if (cells.reference[e] == body)
      for (const VertexId v : cells.vertices[e]) marks[v] = 1;
  return marks;
}

TYPED_TEST(MoveAlong, TensorsOfAMetricTurnWithTheirBody) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Random random(3);
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.5, 0.2, Dim == 2 ? 16 : 8);
  for (int trial = 0; trial < 4; ++trial) {
    const Rotation<Dim> rotation = random_rotation<Dim>(random);
    const Metric<Dim> before = stretched<Dim>(0.08, random_rotation<Dim>(random));
    const AnyField metric = uniform_metric<Dim>(executor, mesh, before);
    const MovedMesh moved =
        move(executor, mesh, displacement_of(mesh, turn_by(rotation)), {.metric = &metric});
    EXPECT_GT(moved.report.adaptations, 0);
    const auto tensors = tensors_of<Dim>(executor, moved.metric);
    const auto marks = in_body<Dim>(moved.mesh);
    for (std::size_t v = 0; v < tensors.size(); ++v)
      if (marks[v]) {
        EXPECT_LT(difference(tensors[v], rotation.turned(before)), 1e-9) << trial;
      }
  }
}

/// A deforming mesh keeps sizes, and turns their directions as F^-T M F^-1 does.
TYPED_TEST(MoveAlong, TensorsTurnWithWhatDeforms) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Random random(4);
  int compared = 0;
  const AnyMesh mesh = test::make_grid(test::unit_grid(Dim, 4));
  for (int trial = 0; trial < 10; ++trial) {
    const Rotation<Dim> rotation = random_rotation<Dim>(random);
    const double stretch = uniform(random, 0.8, 1.3);
    std::vector<Vector<Dim>> vectors;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vector<Dim> point = position_in<Dim>(mesh, v);
      Vector<Dim> longer = point;
      longer[0] *= stretch;
      vectors.push_back(rotation.turned(longer) - point);
    }
    const Metric<Dim> before = stretched<Dim>(0.1, random_rotation<Dim>(random));
    const AnyField metric = uniform_metric<Dim>(executor, mesh, before);
    const MovedMesh moved = move(executor, mesh, vector_field(vectors),
                                 {.remeshes = false, .keep_partial = true, .metric = &metric});
    if (moved.report.share < 1) continue;
    for (const Metric<Dim>& tensor : tensors_of<Dim>(executor, moved.metric)) {
      const auto sizes = principal_axes(tensor).value, expected = principal_axes(before).value;
      EXPECT_NEAR(*std::ranges::min_element(sizes) / *std::ranges::min_element(expected), 1, 1e-9);
      EXPECT_NEAR(*std::ranges::max_element(sizes) / *std::ranges::max_element(expected), 1, 1e-9);
      if (moved.report.steps > 1) continue;
      // M^-1 becomes F M^-1 F'; its axes are those of the tensor.
      const auto pulled = [&](const Vector<Dim>& d) {  // F' d
        Vector<Dim> result = Rotation<Dim>{-rotation.angle, rotation.axis}.turned(d);
        result[0] *= stretch;
        return result;
      };
      const auto axes = principal_axes(tensor).vector;
      for (std::size_t i = 0; i < Dim; ++i)
        for (std::size_t j = 0; j < i; ++j) {
          if (std::abs(sizes[i] / sizes[j] - 1) < 1e-6) continue;
          const Vector<Dim> sum = pulled(axes[i] + axes[j]), off = pulled(axes[i] - axes[j]);
          const Metric<Dim> back = inverse(before);
          EXPECT_NEAR(squared_length(back, sum) / squared_length(back, off), 1, 1e-9);
          ++compared;
        }
    }
  }
  EXPECT_GT(compared, 0);
}

TYPED_TEST(MoveAlong, NamedFieldsTurnAndOthersDoNot) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Random random(5);
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.5, 0.2, Dim == 2 ? 16 : 8);
  using Type = AnyField::Type;
  std::vector<NamedField> fields;
  for (const Place place : {Place::vertices, Place::elements})
    for (const Type type : {Type::vector, Type::symmetric, Type::matrix}) {
      const std::string name = "f" + std::to_string(fields.size());
      std::vector<double> value, values;
      for (int k = 0; k < component_count(type, Dim); ++k) value.push_back(uniform(random, -1, 1));
      const std::size_t count =
          place == Place::vertices ? mesh.vertex_count() : elements_in<Dim>(mesh).size();
      for (std::size_t i = 0; i < count; ++i)
        values.insert(values.end(), value.begin(), value.end());
      fields.push_back({name, type, values, place});
      fields.push_back({"still " + name, type, values, place});
    }
  const Rotation<Dim> rotation = random_rotation<Dim>(random);
  const MovedMesh moved = move(executor, mesh, displacement_of(mesh, turn_by(rotation)),
                               {.fields = fields, .turned = {"f0", "f2", "f4", "f6", "f8", "f10"}});
  // d' T d is the same for the turned d.
  const auto measured = [](const NamedField& field, std::size_t i, const Vector<Dim>& d) {
    const auto n = static_cast<std::size_t>(component_count(field.type, Dim));
    const double* x = &field.values[i * n];
    double sum = 0;
    for (std::size_t r = 0; r < Dim; ++r) {
      if (field.type == Type::vector) sum += x[r] * d.x[r];
      for (std::size_t c = 0; c < Dim && field.type == Type::matrix; ++c)
        sum += d.x[r] * x[r * Dim + c] * d.x[c];
    }
    Metric<Dim> tensor;
    if (field.type == Type::symmetric) std::copy_n(x, tensor.m.size(), tensor.m.begin());
    return sum + squared_length(tensor, d);
  };
  const auto marks = in_body<Dim>(moved.mesh);
  const auto& references = elements_in<Dim>(moved.mesh).reference;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const bool at_vertices = fields[f].place == Place::vertices, turns = f % 2 == 0;
    for (std::size_t i = 0; i < (at_vertices ? marks.size() : references.size()); ++i) {
      if (turns && !(at_vertices ? marks[i] != 0 : references[i] == body)) continue;
      for (int axis = 0; axis < Dim; ++axis) {
        Vector<Dim> d = all<Dim>(0.3);
        d[axis] = 1;
        EXPECT_NEAR(measured(moved.fields[f], i, turns ? rotation.turned(d) : d),
                    measured(fields[f], 0, d), 1e-9)
            << f;
      }
    }
  }
  EXPECT_THROW(move(executor, mesh, displacement_of(mesh, turn_by(rotation)),
                    {.fields = fields, .turned = {"f1"}}),
               InputError);
}

/// Each origin of a moved mesh says the truth, over motions with and without adaptations.
TYPED_TEST(MoveAlong, OriginsAreKept) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.3, 0.18, Dim == 2 ? 20 : 8);
  for (const double way : {0.0, 0.03, 0.4}) {
    const AnyField displacement = displacement_of<Dim>(
        mesh, [&](const Vector<Dim>& p) { return p + along_x<Dim>(way, way / 5); });
    const std::vector<NamedField> places{{"place", AnyField::Type::vector, mesh.coordinates}};
    const MovedMesh moved = move(executor, mesh, displacement, {.fields = places});
    EXPECT_EQ(moved.report.adaptations > 0, way > 0.3);
    const Origins& origins = moved.origins;
    ASSERT_EQ(origins.vertex.size(), moved.mesh.vertex_count());
    const auto marks = in_body<Dim>(moved.mesh);
    for (std::size_t v = 0; v < origins.vertex.size(); ++v) {
      if (way < 0.3 || marks[v]) {
        EXPECT_NE(origins.vertex[v], none);
      }
      Vector<Dim> place, hosted;
      for (int i = 0; i < Dim; ++i)
        place[i] = moved.fields[0].values[v * Dim + static_cast<std::size_t>(i)];
      const auto& corners = elements_in<Dim>(mesh).vertices[origins.host[v]];
      for (std::size_t i = 0; i <= Dim; ++i)
        hosted += origins.weight[v * (Dim + 1) + i] * position_in<Dim>(mesh, corners[i]);
      EXPECT_LT(norm(hosted - place), 1e-9);
      if (origins.vertex[v] != none) {
        EXPECT_EQ(position_in<Dim>(mesh, origins.vertex[v]), place);
      }
    }
    const auto expect_corners = [&](const auto& now, const auto& before, const auto& origin_of) {
      ASSERT_EQ(origin_of.size(), now.size());
      std::size_t kept = 0;
      for (std::size_t i = 0; i < now.size(); ++i) {
        if (origin_of[i] == none) continue;
        ++kept;
        EXPECT_EQ(now.reference[i], before.reference[origin_of[i]]);
        std::vector<VertexId> from;
        for (const VertexId v : now.vertices[i]) from.push_back(origins.vertex[v]);
        EXPECT_TRUE(std::ranges::is_permutation(from, before.vertices[origin_of[i]]));
      }
      EXPECT_GT(kept, before.size() / 10);
      if (way < 0.3) {
        EXPECT_EQ(kept, before.size());
      }
    };
    expect_corners(elements_in<Dim>(moved.mesh), elements_in<Dim>(mesh), origins.element);
    expect_corners(facets_in<Dim>(moved.mesh), facets_in<Dim>(mesh), origins.facet);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::move_test
