/// @file
/// Adapts parts made with Gmsh and OpenCASCADE (tests/meshadapt/parts), again and again, in coarse
/// and in fine facets, with and without a geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <tuple>

#include "core/determinant.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::curved_parts_test {
namespace {

using runtime::Executor;
using Point = Vector<3>;

// ---- Distance of a point from the true surface of a part, given the reference of its facet ----

double off_plate(const Point& p, std::int32_t reference) {
  return reference == 7 ? std::abs(std::hypot(p[0], p[1]) - 0.4) : 0;
}
double off_cut_sphere(const Point& p, std::int32_t reference) {
  return reference == 1 ? std::abs(norm(p) - 1) : std::abs(p[2] - 0.6);
}
double off_rounded_box(const Point& p, std::int32_t) {
  const Point size{{1, 0.8, 0.6}};
  Point inner;
  for (int i = 0; i < 3; ++i) inner[i] = std::clamp(p[i], 0.2, size[i] - 0.2);
  return std::abs(norm(p - inner) - 0.2);
}
double off_torus(const Point& p, std::int32_t) {
  return std::abs(std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - 0.35);
}
/// Starts at the closest of many points of the ellipse and searches both sides with shrinking
/// steps.
double off_ellipse(double x, double y, double a, double b) {
  const auto distance = [&](double at) {
    return std::hypot(x - a * std::cos(at), y - b * std::sin(at));
  };
  constexpr int n = 64;
  double step = 2 * std::numbers::pi / n, best = 0;
  for (int i = 0; i < n; ++i)
    if (distance(i * step) < distance(best)) best = i * step;
  for (; step > 1e-9; step *= 0.7)
    for (const double at : {best - step, best + step})
      if (distance(at) < distance(best)) best = at;
  return distance(best);
}
double off_plate2d(const Point& p, std::int32_t reference) {
  if (reference == 5) return std::abs(std::hypot(p[0] + 0.2, p[1]) - 0.4);
  if (reference != 6) return 0;
  return off_ellipse(p[0] - 0.6, p[1] - 0.3, 0.3, 0.15);
}

struct Part {
  const char* name;
  double tolerance;  // more than the error of chords of its coarse mesh, which is therefore smooth
  double size;       // length of edges
  double (*off)(const Point&, std::int32_t);  // null if the surface is not known
  // Largest distance of facets from the surface without a geometry, in tolerances, from the coarse
  // mesh.
  double most_off = 1.4;
};
constexpr std::array parts{
    Part{"plate", 0.02, 0.3, off_plate, 1.5},
    Part{"cut_sphere", 0.06, 0.4, off_cut_sphere},
    Part{"rounded_box", 0.02, 0.2, off_rounded_box},
    Part{"torus", 0.04, 0.3, off_torus},
    Part{"blade", 0.01, 0.3, nullptr},
    Part{"plate2d", 0.015, 0.2, off_plate2d, 1.2},
};

AnyMesh read(const Part& part, bool fine) {
  return read_mesh(std::string(DUCTILE_PARTS) + "/" + part.name +
                   (fine ? ".fine.meshb" : ".coarse.meshb"));
}

Point point_of(const AnyMesh& mesh, std::uint32_t v) {
  Point p;
  for (int i = 0; i < mesh.dimension; ++i)
    p[i] = mesh.coordinates[v * static_cast<std::size_t>(mesh.dimension) +
                            static_cast<std::size_t>(i)];
  return p;
}

/// Calls visit(corners, reference) for the facets.
void each_facet(const AnyMesh& mesh, auto&& visit) {
  const auto each = [&](const auto& facets) {
    for (std::size_t f = 0; f < facets.size(); ++f) visit(facets.vertices[f], facets.reference[f]);
  };
  mesh.dimension == 2 ? each(mesh.edges) : each(mesh.triangles);
}

/// Largest distance of points of facets from the true surface.
double off_surface(const Part& part, const AnyMesh& mesh) {
  double most = 0;
  each_facet(mesh, [&](const auto& corners, std::int32_t reference) {
    const Point a = point_of(mesh, corners.front()), b = point_of(mesh, corners[1]),
                c = point_of(mesh, corners.back());
    constexpr int n = 6;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        most = std::max(most, part.off((1.0 / n) * (i * a + j * b + (n - i - j) * c), reference));
  });
  return most;
}

double volume_of(const AnyMesh& mesh) {
  double sum = 0;
  const auto add = [&]<int Dim>(std::integral_constant<int, Dim>) {
    for (const auto& corners : test::elements<Dim>(mesh).vertices) {
      std::array<Vector<Dim>, Dim + 1> points;
      for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = test::point<Dim>(mesh, corners[i]);
      sum += plain_determinant(points);
    }
  };
  mesh.dimension == 2 ? add(std::integral_constant<int, 2>())
                      : add(std::integral_constant<int, 3>());
  return sum;
}

std::set<std::int32_t> references_of(const AnyMesh& mesh) {
  std::set<std::int32_t> references;
  each_facet(mesh, [&](const auto&, std::int32_t r) { references.insert(r); });
  return references;
}

/// Sizes with a front that moves from call to call.
AnyField front(const AnyMesh& mesh, double size, int call) {
  AnyField sizes{mesh.dimension, mesh.vertex_count(), {AnyField::Type::scalar}, {}, "sizes"};
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const double away = std::abs(point_of(mesh, v)[0] - 0.5 * std::cos(0.7 * call));
    sizes.values.push_back(std::min(size, 0.5 * size + 0.4 * away));
  }
  return metric_of(sizes, mesh, {});
}

using Case = std::tuple<Part, bool, bool>;  // fine facets, with a geometry

class CurvedPart : public testing::TestWithParam<Case> {
 protected:
  const Part& part() const { return std::get<0>(GetParam()); }
  bool fine() const { return std::get<1>(GetParam()); }
  bool has_geometry() const { return std::get<2>(GetParam()); }
  double tolerance() const { return fine() ? part().tolerance / 3 : part().tolerance; }
  AdaptOptions options_on(const AnyMesh& mesh) const {
    AdaptOptions options;
    options.make.hausdorff_tolerance = tolerance();
    options.gradation = 1.5;
    if (has_geometry())
      options.make.geometry = std::make_shared<const Geometry>(
          executor, mesh, GeometryOptions{.tolerance = tolerance()});
    return options;
  }
  const Executor executor{{.threads = 2}};
};
INSTANTIATE_TEST_SUITE_P(Parts, CurvedPart,
                         testing::Combine(testing::ValuesIn(parts), testing::Bool(),
                                          testing::Bool()),
                         [](const auto& at) {
                           return std::string(std::get<0>(at.param).name) +
                                  (std::get<1>(at.param) ? "_fine" : "_coarse") +
                                  (std::get<2>(at.param) ? "_with_geometry" : "");
                         });

TEST_P(CurvedPart, StaysWhatItIsInTenCalls) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  // Chords of the wall of the plate's hole come close to its sides, so that they are flat in the
  // next model. The ellipse has a least radius of five tolerances and no corners.
  const double most_off = has_geometry() ? 1.3 : fine() ? 1.4 : part().most_off;
  const AnyMesh start = read(part(), fine());
  const AdaptOptions options = options_on(start);
  AnyMesh mesh = start;
  double first = 0;
  for (int call = 0; call < 10; ++call) {
    mesh = adapt(executor, mesh, front(mesh, part().size, call), options).mesh;
    SCOPED_TRACE(call);
    EXPECT_EQ(test::joined(check_adapted(executor, start, mesh, 2 * tolerance())), "");
    EXPECT_EQ(references_of(mesh), references_of(start));
    if (part().off != nullptr) {
      EXPECT_LT(off_surface(part(), mesh), most_off * tolerance());
    }
    if (call == 0) first = volume_of(mesh);
  }
  EXPECT_NEAR(volume_of(mesh) / first, 1, fine() ? 0.003 : 0.015);
}

/// Facets of one reference are required; they must remain exactly as they were.
TEST_P(CurvedPart, LeavesRequiredFacetsAlone) {
  AnyMesh start = read(part(), fine());
  const bool flat = start.dimension == 2;
  const auto& references = flat ? start.edges.reference : start.triangles.reference;
  const std::int32_t kept = flat ? 5 : *references.begin();
  auto& required = flat ? start.required_edges : start.required_triangles;
  for (std::uint32_t f = 0; f < references.size(); f += 2)
    if (references[f] == kept) required.push_back(f);
  ASSERT_FALSE(required.empty());
  const AdaptedMesh result =
      adapt(executor, start, front(start, part().size, 0), options_on(start));
  EXPECT_EQ(test::joined(check_adapted(executor, start, result.mesh, tolerance())), "");
  std::set<std::set<std::array<double, 3>>> there;
  each_facet(result.mesh, [&](const auto& corners, std::int32_t) {
    std::set<std::array<double, 3>> points;
    for (const std::uint32_t v : corners) points.insert(point_of(result.mesh, v).x);
    there.insert(points);
  });
  std::size_t f = 0, missing = 0;
  each_facet(start, [&](const auto& corners, std::int32_t reference) {
    if (f++ % 2 != 0 || reference != kept) return;
    std::set<std::array<double, 3>> points;
    for (const std::uint32_t v : corners) points.insert(point_of(start, v).x);
    missing += 1 - there.count(points);
  });
  EXPECT_EQ(missing, 0U);
}

}  // namespace
}  // namespace ductile::meshadapt::curved_parts_test
