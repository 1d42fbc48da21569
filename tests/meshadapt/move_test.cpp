/// @file
/// Meshes that move: bodies go where they should, facets and quality stay, whatever went along
/// keeps its integral.
#include "ductile/meshadapt/move.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core/quality.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "move_support.hpp"
#include "support/broken_input.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::move_test {
namespace {

using test::Random;
using test::uniform;
using Place = NamedField::Place;

template <class Dimension>
class MoveIn : public testing::Test {};
TYPED_TEST_SUITE(MoveIn, test::Dimensions, );

// ---- Bodies ----

TYPED_TEST(MoveIn, BodiesMoveByMoreThanTheirSize) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh =
      box_with_ball<Dim>(executor, 0.25, Dim == 2 ? 0.12 : 0.15, Dim == 2 ? 32 : 10);
  const Vector<Dim> way = along_x<Dim>(0.5, 0.05);
  const auto moved = moved_well<Dim>(
      executor, mesh, [&](const Vector<Dim>& p) { return p + way; }, Dim == 2 ? 0.3 : 0.15);
  EXPECT_GT(moved.report.adaptations, 0);
  EXPECT_EQ(test::joined(test::changes_of_what_is_kept(mesh, moved.mesh)), "");
}

TEST(Move, BodiesTurnOnTheirWay) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with<2>(executor, {{{{0.5, 0.5}}, {{0.36, 0.1}}}}, 30);
  const auto moved = moved_well<2>(executor, mesh, turn(176), 0.2);
  EXPECT_EQ(test::joined(test::changes_of_what_is_kept(mesh, moved.mesh)), "");
}

TEST(Move, BodiesTurnInSpace) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with<3>(executor, {{all<3>(0.5), {{0.35, 0.2, 0.2}}}}, 10);
  moved_well<3>(executor, mesh, turn_in_space(90, {{0.1, 0.3, 1}}), 0.12);
}

TEST(Move, DiscsPassEachOtherInManyCalls) {
  const Executor executor({.threads = 2});
  AnyMesh mesh = box_with<2>(
      executor, {{{{0.25, 0.36}}, {{0.12, 0.12}}}, {{{0.75, 0.64}}, {{0.12, 0.12}}}}, 25);
  const double volume = measures<2>(executor, mesh).volume;
  const Motion<2> step = [](const Vector<2>& p) {
    return p + Vector<2>{{p[1] < 0.5 ? 0.025 : -0.025, 0}};
  };
  for (int call = 0; call < 20; ++call) {
    MovedMesh moved = move(executor, mesh, displacement_of(mesh, step));
    mesh = std::move(moved.mesh);
    ASSERT_GT(worst_shape<2>(mesh), 0.2) << call;
  }
  EXPECT_EQ(test::joined(check_mesh(executor, mesh)), "");
  EXPECT_NEAR(measures<2>(executor, mesh).volume / volume, 1, 1e-9);
}

TYPED_TEST(MoveIn, BodiesDeform) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.5, 0.2, Dim == 2 ? 30 : 10);
  moved_well<Dim>(
      executor, mesh,
      [](const Vector<Dim>& p) {
        Vector<Dim> d = p - all<Dim>(0.5);
        d[0] *= Dim == 2 ? 2 : 1.5;
        d[1] *= Dim == 2 ? 0.5 : 0.7;
        d[1] += 0.5 * d[0] * d[0];
        return all<Dim>(0.5) + d;
      },
      Dim == 2 ? 0.3 : 0.12);
}

TYPED_TEST(MoveIn, NamedBodiesMoveAndOthersStay) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.4, 0.2, 10);
  AnyField displacement =
      displacement_of<Dim>(mesh, [](const Vector<Dim>& p) { return p + along_x<Dim>(0.1); });
  const MovedMesh expected = move(executor, mesh, displacement);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)  // what the others have is ignored
    if (displacement.values[v * Dim] == 0) displacement.values[v * Dim + 1] = 7;
  const MovedMesh moved = move(executor, mesh, displacement, {.bodies = {body}});
  EXPECT_EQ(moved.mesh, expected.mesh);
  EXPECT_EQ(moved.metric.values, expected.metric.values);
}

TYPED_TEST(MoveIn, TheWholeMeshMoves) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  AnyMesh mesh = test::make_grid(test::unit_grid(Dim, 6));
  Random random(3);
  test::jiggle(mesh, random, 0.2);
  std::vector<Vector<Dim>> vectors;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vector<Dim> p = position_in<Dim>(mesh, v);
    vectors.push_back(along_x<Dim>(5 + p[1] * p[1], 3));
  }
  const MovedMesh moved = move(executor, mesh, vector_field(vectors));
  EXPECT_EQ(test::joined(check_mesh(executor, moved.mesh)), "");
  const auto before = make_fixed_mesh<Dim>(executor, mesh),
             after = make_fixed_mesh<Dim>(executor, moved.mesh);
  const auto sum = [](const auto& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  EXPECT_NEAR(sum(after.volume_of), sum(before.volume_of), 1e-9);  // shears keep volumes
}

TYPED_TEST(MoveIn, BoundariesMoveAndTheirNeighboursGiveWay) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 12 : 5));
  const AnyField piston =
      vector_field(std::vector<Vector<Dim>>(mesh.vertex_count(), along_x<Dim>(-0.6)), "piston");
  const MovedMesh moved = move(executor, mesh, piston, {.boundaries = {2}});  // faces +x
  EXPECT_EQ(test::joined(check_mesh(executor, moved.mesh)), "");
  EXPECT_GT(worst_shape<Dim>(moved.mesh), 0.15);
  const auto fixed = make_fixed_mesh<Dim>(executor, moved.mesh);
  EXPECT_NEAR(std::accumulate(fixed.volume_of.begin(), fixed.volume_of.end(), 0.0), 0.4, 1e-9);
  const auto& facets = facets_in<Dim>(moved.mesh);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (facets.reference[f] != 2) continue;
    for (const VertexId v : facets.vertices[f])
      EXPECT_DOUBLE_EQ(position_in<Dim>(moved.mesh, v)[0], 0.4);
  }
}

// ---- Near there only ----

TYPED_TEST(MoveIn, WhatIsFarKeepsItsBytes) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const double radius = Dim == 2 ? 0.04 : 0.07;
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.2, radius, Dim == 2 ? 60 : 14);
  const AnyField displacement = displacement_of<Dim>(mesh, [&](const Vector<Dim>& p) {
    return p + along_x<Dim>((Dim == 2 ? 1.5 : 0.5) * radius);
  });
  const MovedMesh moved =
      move(executor, mesh, displacement, {.remesh_below = Dim == 2 ? 0.6 : 0.5});
  EXPECT_GT(moved.report.adaptations, 0);
  const auto elements_from = [](const AnyMesh& of, double x) {
    std::vector<std::array<std::array<double, Dim>, Dim + 1>> list;
    for (const auto& corners : elements_in<Dim>(of).vertices) {
      std::array<std::array<double, Dim>, Dim + 1> points;
      double left = 1;
      for (std::size_t i = 0; i <= Dim; ++i) {
        points[i] = position_in<Dim>(of, corners[i]).x;
        left = std::min(left, points[i][0]);
      }
      if (left > x) list.push_back(points);
    }
    return list;
  };
  const double far = Dim == 2 ? 0.6 : 0.87;
  const auto before = elements_from(mesh, far);
  ASSERT_GT(before.size(), elements_in<Dim>(mesh).size() / 20);
  EXPECT_EQ(elements_from(moved.mesh, far), before);  // in the same order, too
}

TYPED_TEST(MoveIn, NothingMovesWithoutADisplacement) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.5, 0.2, 8);
  const MovedMesh moved =
      move(executor, mesh, vector_field(std::vector<Vector<Dim>>(mesh.vertex_count())));
  EXPECT_EQ(moved.mesh.coordinates, mesh.coordinates);
  EXPECT_EQ(elements_in<Dim>(moved.mesh), elements_in<Dim>(mesh));
}

TYPED_TEST(MoveIn, TheResultDoesNotDependOnThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh =  // in 2D with several blocks of the preconditioner
      box_with_ball<Dim>(Executor({.threads = 1}), 0.3, 0.18, Dim == 2 ? 80 : 7);
  const AnyField displacement =
      displacement_of<Dim>(mesh, [](const Vector<Dim>& p) { return p + along_x<Dim>(0.35, 0.1); });
  const std::vector<NamedField> fields{
      {"u", AnyField::Type::scalar, std::vector<double>(mesh.vertex_count(), 0.1)}};
  const MoveOptions options{.fields = fields, .carrying = {Carrying::conservatively}};
  const MovedMesh one = move(Executor({.threads = 1}), mesh, displacement, options);
  EXPECT_GT(one.report.adaptations, 0);
  for (const int threads : test::thread_counts) {
    const MovedMesh many = move(Executor({.threads = threads}), mesh, displacement, options);
    EXPECT_EQ(many.mesh, one.mesh) << threads;
    EXPECT_EQ(many.metric.values, one.metric.values) << threads;
    EXPECT_EQ(many.fields[0].values, one.fields[0].values) << threads;
  }
}

// ---- What goes along ----

TYPED_TEST(MoveIn, IntegralsAreKeptOverTheWholeMotion) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.3, 0.18, Dim == 2 ? 24 : 8);
  Random random(5);
  std::vector<NamedField> fields{{"u", AnyField::Type::vector, {}, Place::vertices},
                                 {"e", AnyField::Type::scalar, {}, Place::elements},
                                 {"material", AnyField::Type::scalar, {}, Place::elements},
                                 {"one", AnyField::Type::scalar, {}, Place::vertices}};
  for (std::size_t i = 0; i < mesh.vertex_count() * Dim; ++i)
    fields[0].values.push_back(uniform(random, -1, 3));
  for (const std::int32_t reference : elements_in<Dim>(mesh).reference) {
    fields[1].values.push_back(uniform(random, 0, 2));
    fields[2].values.push_back(reference);
  }
  fields[3].values.assign(mesh.vertex_count(), 1);
  const auto displacement =
      displacement_of<Dim>(mesh, [](const Vector<Dim>& p) { return p + along_x<Dim>(0.4, 0.02); });
  const MovedMesh moved = move(executor, mesh, displacement,
                               {.fields = fields,
                                .carrying = {Carrying::conservatively, Carrying::conservatively,
                                             Carrying::by_value, Carrying::by_value}});
  EXPECT_GT(moved.report.adaptations, 0);
  const auto before = make_fixed_mesh<Dim>(executor, mesh),
             after = make_fixed_mesh<Dim>(executor, moved.mesh);
  const auto total = [](const std::vector<double>& weights, const NamedField& field,
                        std::size_t component, std::size_t stride) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum += weights[i] * field.values[i * stride + component];
    return sum;
  };
  for (std::size_t k = 0; k < Dim; ++k)
    EXPECT_NEAR(total(after.share_of, moved.fields[0], k, Dim),
                total(before.share_of, fields[0], k, Dim), 1e-12);
  EXPECT_NEAR(total(after.volume_of, moved.fields[1], 0, 1),
              total(before.volume_of, fields[1], 0, 1), 1e-12);
  for (std::size_t e = 0; e < after.element_count(); ++e)
    EXPECT_EQ(moved.fields[2].values[e], elements_in<Dim>(moved.mesh).reference[e]);
  for (const double one : moved.fields[3].values) EXPECT_NEAR(one, 1, 1e-14);
}

TYPED_TEST(MoveIn, AGivenMetricGoesAlong) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.3, 0.18, Dim == 2 ? 16 : 8);
  const AnyField metric = constant_metric(mesh, Dim == 2 ? 0.03 : 0.09);
  const auto displacement =
      displacement_of<Dim>(mesh, [](const Vector<Dim>& p) { return p + along_x<Dim>(0.4); });
  const MovedMesh moved = move(executor, mesh, displacement, {.metric = &metric});
  ASSERT_EQ(moved.metric.vertex_count, moved.mesh.vertex_count());
  EXPECT_GT(elements_in<Dim>(moved.mesh).size(), elements_in<Dim>(mesh).size());
}

// ---- Ways that end early ----

TYPED_TEST(MoveIn, ABlockedWayIsAnErrorThatSaysWhere) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = box_with_ball<Dim>(executor, 0.5, 0.2, Dim == 2 ? 20 : 10);
  const auto displacement = displacement_of<Dim>(  // through the wall
      mesh, [](const Vector<Dim>& p) { return p + along_x<Dim>(0.6); });
  try {
    move(executor, mesh, displacement);
    FAIL();
  } catch (const InputError&) {
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("stopped at"), std::string::npos) << text;
    EXPECT_NE(text.find(Dim == 2 ? "a triangle at (" : "a tetrahedron at ("), std::string::npos)
        << text;
  }
  const MovedMesh part = move(executor, mesh, displacement, {.keep_partial = true});
  EXPECT_GT(part.report.share, 0.3);  // 0.5 is where the ball touches the wall
  EXPECT_LT(part.report.share, 0.51);
  EXPECT_NE(part.report.stopped, "");
  EXPECT_EQ(test::joined(check_mesh(executor, part.mesh)), "");
  EXPECT_NEAR(measures<Dim>(executor, part.mesh).volume, measures<Dim>(executor, mesh).volume,
              1e-9);
  EXPECT_THROW(move(executor, mesh, displacement, {.remeshes = false}), Error);
  EXPECT_THROW(move(executor, mesh, displacement, {.most_steps = 1}), Error);
}

TEST(Move, InvalidInputIsRefused) {
  const Executor executor({.threads = 1});
  const AnyMesh mesh = test::make_grid(test::unit_grid(2, 3));
  std::vector<Vector<2>> vectors(mesh.vertex_count(), {{0.1, 0}});
  const AnyField displacement = vector_field(vectors);
  const auto refused = [&](const AnyField& field, const MoveOptions& options,
                           const std::string& expected) {
    try {
      move(executor, mesh, field, options);
      FAIL() << expected;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  refused(displacement, {.bodies = {77}}, "bodies: expected references of elements, found 77");
  refused(displacement, {.boundaries = {77}}, "boundaries: expected references of edges, found 77");
  refused(displacement, {.keep_above = 2}, "expected qualities from 0 to 1, found 2");
  refused(displacement, {.most_steps = 0}, "expected 1 step or more, found 0");
  refused(scalar_field(2, std::vector<double>(mesh.vertex_count())), {}, "expected one vector");
  vectors[4][1] = std::numeric_limits<double>::quiet_NaN();
  refused(vector_field(vectors), {}, "vertex 5 has a displacement that is not finite");
  vectors.pop_back();
  refused(vector_field(vectors), {}, "expected");
  const std::vector<NamedField> fields{{"u", AnyField::Type::scalar, {1, 2}}};
  refused(displacement, {.fields = fields}, "field 'u': expected 16 values, found 2");
  const AnyField metric = scalar_field(2, {1});
  refused(displacement, {.metric = &metric}, "expected");
}

/// Any motion of any body ends with a valid mesh, at its end or before; nothing is lost that lists
/// and marks say.
TYPED_TEST(MoveIn, AnyMotionLeavesAValidMesh) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Random random(11);
  for (std::uint64_t seed = 0; seed < (Dim == 2 ? 24 : 6); ++seed) {
    test::Grid grid = test::unit_grid(Dim, Dim == 2 ? 9 : 6);
    const auto where = test::random_regions(seed, 3, seed % 2 == 0);
    grid.region = [&](const test::Cell& cell) {
      const auto [least, most] = std::minmax_element(cell.begin(), cell.begin() + Dim);
      const int off = std::max(2 - *least, *most - 3);
      return off <= 0 ? 9 : off == 1 ? 8 : where(cell);  // regions do not touch the body
    };
    AnyMesh mesh = test::make_grid(grid);
    if (Dim == 3) test::list_ridges(mesh);
    test::jiggle(mesh, random, 0.2);
    const double scale = seed % 3 == 0 ? 1e-3 : 1;
    test::place(mesh, random, scale, scale);
    std::vector<Vector<Dim>> vectors(mesh.vertex_count());
    Vector<Dim> shift;
    for (int i = 0; i < Dim; ++i) shift[i] = scale * uniform(random, -0.2, 0.2);
    const auto& cells = elements_in<Dim>(mesh);
    for (std::size_t e = 0; e < cells.size(); ++e)
      if (cells.reference[e] == 9)
        for (const VertexId v : cells.vertices[e]) {
          vectors[v] = shift;
          if (seed % 4 == 3) vectors[v][0] += uniform(random, -0.02, 0.02) * scale;
        }
    std::erase_if(mesh.corners, [&](VertexId v) { return !(vectors[v] == Vector<Dim>{}); });
    const MovedMesh moved = move(executor, mesh, vector_field(vectors), {.keep_partial = true});
    EXPECT_EQ(test::joined(check_mesh(executor, moved.mesh)), "") << seed;
    EXPECT_TRUE(moved.report.share == 1 || !moved.report.stopped.empty()) << seed;
    const std::string changes = test::joined(test::changes_of_what_is_kept(mesh, moved.mesh));
    if (seed % 4 != 3) {
      EXPECT_EQ(changes, "") << seed;
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::move_test
