#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "picture/draw.hpp"
#include "picture/ellipses.hpp"
#include "picture/scene.hpp"
#include "picture/ticks.hpp"
#include "shown_field.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::cli::picture_test {
namespace {

using meshadapt::AnyMesh;

AnyMesh square() {
  AnyMesh mesh;
  mesh.name = "square.mesh";
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 1, 0, 1, 1, 0, 1};
  mesh.vertex_reference = {0, 0, 0, 0};
  mesh.triangles.add({0, 1, 2}, 1);
  mesh.triangles.add({0, 2, 3}, 1);
  return mesh;
}

/// Two tetrahedra on either side of the triangle 0 1 2.
AnyMesh two_tetrahedra() {
  AnyMesh mesh;
  mesh.name = "two.mesh";
  mesh.dimension = 3;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1};
  mesh.vertex_reference = {0, 0, 0, 0, 0};
  mesh.tetrahedra.add({0, 1, 2, 3}, 1);
  mesh.tetrahedra.add({0, 2, 1, 4}, 2);
  mesh.triangles.add({0, 1, 3}, 7);
  return mesh;
}

double area(const Face& face) {
  double sum = 0;
  for (int i = 0; i < face.corners; ++i) {
    const Point& a = face.corner[static_cast<std::size_t>(i)];
    const Point& b = face.corner[static_cast<std::size_t>((i + 1) % face.corners)];
    sum += (a.x * b.y - a.y * b.x) / 2;
  }
  return std::abs(sum);
}

TEST(Scene, HasEachTriangleAndTheBoundaryOnce) {
  const Scene scene = make_scene(runtime::Executor({.threads = 2}), square(), nullptr, {});
  ASSERT_EQ(scene.panels.size(), 1U);
  EXPECT_EQ(scene.panels[0].faces.size(), 2U);
  EXPECT_EQ(scene.panels[0].lines.size(), 4U);
  EXPECT_NEAR(scene.panels[0].faces[0].colour.blue, quality_colour(std::sqrt(3.0) / 2).blue, 1e-12);
}

TEST(Scene, DrawsALineBetweenReferences) {
  AnyMesh mesh = square();
  mesh.triangles.reference[1] = 2;
  const Scene scene =
      make_scene(runtime::Executor({.threads = 1}), mesh, nullptr, {.tint = Tint::reference});
  EXPECT_EQ(scene.panels[0].lines.size(), 5U);
  EXPECT_EQ(scene.legends[0].references, (std::vector<std::int32_t>{1, 2}));
}

TEST(Scene, ShowsOnlyTheFrontOfASolid) {
  const AnyMesh mesh = two_tetrahedra();
  const Camera camera = camera_along(1);
  const Panel panel = surface_panel(mesh, camera);
  // From the right, the front and above, the faces at y = 0 and the slanted ones that face the
  // camera are visible; the shared one never is.
  EXPECT_GE(panel.faces.size(), 3U);
  EXPECT_LE(panel.faces.size(), 4U);
}

TEST(Scene, CutsThroughTheMiddle) {
  const AnyMesh mesh = two_tetrahedra();
  for (int axis = 0; axis < 3; ++axis) {
    const Camera camera = camera_along(axis);
    const Panel panel = cut_panel(mesh, {quality_colour(0.1), quality_colour(0.9)}, camera, axis);
    double section = 0;
    for (const Face& face : panel.faces)
      if (face.colour == quality_colour(0.1) || face.colour == quality_colour(0.9))
        section += area(face);
    // The cuts at x = 1/2 and y = 1/2 are two triangles of area 1/8 each; the cut at z = 0 is the
    // shared facet. Projection shrinks the area by the cosine.
    const double expected = axis == 2 ? 0.5 : 0.25;
    EXPECT_NEAR(section, expected * std::abs(camera.towards[axis]), 1e-12) << axis;
  }
}

TEST(Scene, RefusesAMeshWithoutElements) {
  AnyMesh mesh = square();
  mesh.triangles = {};
  EXPECT_THROW(make_scene(runtime::Executor({.threads = 1}), mesh, nullptr, {}),
               meshadapt::InputError);
}

TEST(Scene, ShowsAFieldInTheColoursOfItsValues) {
  using meshadapt::NamedField;
  NamedField at_vertices{"u", meshadapt::AnyField::Type::scalar, {-1, 0, 4, 1}};
  SceneOptions options{.tint = Tint::field, .field = &at_vertices};
  const Scene plane = make_scene(runtime::Executor({.threads = 1}), square(), nullptr, options);
  // The mean of -1, 0 and 4, in -1 to 4.
  EXPECT_NEAR(plane.panels[0].faces[0].colour.blue, size_colour(0.4).blue, 1e-12);
  EXPECT_EQ(plane.legends[0].title, "u, at vertices: -1 to 4");
  NamedField on_elements{"k", at_vertices.type, {7, 1 / 0.0}, NamedField::Place::elements};
  options.field = &on_elements;
  const Scene solid =
      make_scene(runtime::Executor({.threads = 1}), two_tetrahedra(), nullptr, options);
  EXPECT_EQ(solid.legends.size(), 1U);  // the surface shows the field, too
  EXPECT_EQ(solid.legends[0].title, "k, on elements: 7; grey: infinite");
  bool grey = false, coloured = false;
  for (const Face& face : solid.panels[0].faces) {
    const Colour& c = face.colour;
    (c.red == c.green && c.green == c.blue ? grey : coloured) = true;
  }
  EXPECT_TRUE(grey && coloured);
}

TEST(Scene, ShowsTheMetricInTheCut) {
  const meshadapt::AnyMesh box = meshadapt::box_mesh<3>({1, 1, 1}, {4, 4, 4});
  const auto metric = meshadapt::test::metric_field<3>(box, [](const auto&) {
    return meshadapt::Metric<3>{{100, 0, 25, 0, 0, 1 / 0.09}};
  });
  const double size_of[] = {std::sqrt(0.2 * 0.3), std::sqrt(0.1 * 0.3), std::sqrt(0.1 * 0.2)};
  for (int axis = 0; axis < 3; ++axis) {
    const Scene scene = make_scene(runtime::Executor({.threads = 1}), box, &metric,
                                   {.tint = Tint::metric, .cut_axis = axis});
    EXPECT_GT(scene.panels.at(1).ellipses.size(), 10U);
    EXPECT_NEAR(scene.legends.back().from * 1.1, size_of[axis], 1e-9);
    EXPECT_NEAR(scene.legends.back().to / 1.1, size_of[axis], 1e-9);
  }
}

/// Is the point inside the ellipse?
bool is_in(const UnitEllipse& e, const Point& p) {
  const double x = p.x - e.centre.x, y = p.y - e.centre.y, area = e.u.x * e.v.y - e.u.y * e.v.x;
  return std::hypot((x * e.v.y - y * e.v.x) / area, (y * e.u.x - x * e.u.y) / area) < 1;
}

TEST(Ellipses, AreManyAndNeverOneOnAnother) {
  using namespace meshadapt;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const int n = seed % 3 == 0 ? 4 : 40;
    const double extent = std::pow(10, test::uniform(random, -9, 9));
    const double thin = std::pow(10, test::uniform(random, -3, 0)),
                 turn = test::uniform(random, 0, 9);
    std::vector<EllipsePlace> places;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const double x = 1.0 * i / n, y = 1.0 * j / n;
        const double size = extent * (0.001 + std::abs(x - y) * test::uniform(random, 0.05, 0.2));
        const double c = std::cos(turn * x), s = std::sin(turn * x);
        const Metric<2> metric = compose<2>(
            {{1 / (size * size), 1 / (size * size * thin * thin)}, {{{{c, s}}, {{-s, c}}}}});
        places.push_back({{extent * x, extent * y},
                          metric,
                          extent * extent / (n + 1) / (n + 1),
                          i % n > 0 && j % n > 0});
      }
    const UnitEllipses chosen = choose_ellipses(places, extent);
    EXPECT_GE(chosen.drawn.size(), n == 4 ? 5U : 150U);
    EXPECT_LE(chosen.drawn.size(), 1500U);
    for (const UnitEllipse& a : chosen.drawn) {
      const double length = std::hypot(a.u.x, a.u.y);
      EXPECT_GE(length, 0.007 * extent);
      EXPECT_LE(length, 0.2 * extent);
      for (const UnitEllipse& b : chosen.drawn) {
        if (&a == &b || std::hypot(a.centre.x - b.centre.x, a.centre.y - b.centre.y) > 0.4 * extent)
          continue;
        for (double t = -1; t <= 1; t += 0.125)  // testing the long axes is enough
          EXPECT_FALSE(is_in(b, {a.centre.x + t * a.u.x, a.centre.y + t * a.u.y}));
      }
    }
  }
}

TEST(Ellipses, AreWhatTheMetricSays) {
  using namespace meshadapt;
  std::vector<EllipsePlace> places;
  const Metric<2> metric{{500, 300, 400}};
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) places.push_back({{i / 30.0, j / 30.0}, metric, 1 / 900.0});
  const UnitEllipses chosen = choose_ellipses(places, 1);
  EXPECT_TRUE(chosen.all_magnified);
  for (const UnitEllipse& ellipse : chosen.drawn)
    for (const Point& axis : {ellipse.u, ellipse.v})
      EXPECT_NEAR(squared_length(metric, {{axis.x, axis.y}}),
                  chosen.magnification * chosen.magnification, 1e-9);
}

TEST(Legend, HasRoundNumbersAtTheirPlaces) {
  meshadapt::test::Random random(1);
  std::vector<std::pair<double, double>> ranges{{0, 1},       {-0.998, 1.02},  {101325, 101325.4},
                                                {1e-9, 3e-9}, {-1e308, 1e308}, {0, 1e-310}};
  for (int i = 0; i < 200; ++i) {
    const double from = meshadapt::test::uniform(random, -1, 1) * std::pow(10, i % 20 - 10);
    ranges.emplace_back(from, from + std::pow(10, meshadapt::test::uniform(random, -4, 4)));
  }
  for (const auto& [from, to] : ranges) {
    SCOPED_TRACE(std::to_string(from) + " " + std::to_string(to));
    for (int most = 2; most <= 6; ++most) {
      const std::vector<Tick> ticks = round_ticks(from, to, most);
      ASSERT_GE(ticks.size(), 1U);
      EXPECT_LE(ticks.size(), static_cast<std::size_t>(most) + 1);
      for (std::size_t i = 0; i < ticks.size(); ++i) {
        const double value = std::strtod(ticks[i].label.c_str(), nullptr);
        const double there = from + ticks[i].at * (to / 2 - from / 2) * 2;
        EXPECT_NEAR(value / 2, there / 2, 1e-6 * (to / 2 - from / 2) + 1e-15 * std::abs(there / 2))
            << ticks[i].label;
        if (i > 0) {
          EXPECT_GT(ticks[i].at, ticks[i - 1].at);
          EXPECT_NE(ticks[i].label, ticks[i - 1].label);
        }
      }
    }
  }
  EXPECT_EQ(round_ticks(5, 5, 6).at(0).label, "5");
  EXPECT_EQ(round_ticks(0, 1, 5).at(1).label, "0.2");
}

TEST(ShownField, IsFoundByNameOrNumberAndComponent) {
  using meshadapt::AnyField;
  using meshadapt::NamedField;
  const std::vector<NamedField> fields{{"u", AnyField::Type::scalar, {-2}},
                                       {"v", AnyField::Type::vector, {3, -4}},
                                       {"2", AnyField::Type::symmetric, {1, 2, -4}},
                                       {"a:1", AnyField::Type::matrix, {1, 2, 3, 4}}};
  const struct {
    const char *by, *name;
    double value;
  } found[] = {{"u", "u", -2},
               {"1", "u", -2},
               {"v", "v (length)", 5},
               {"v:2", "v:2", -4},
               {"2", "2 (norm)", 5},
               {"3:2", "2:2", 2},
               {"a:1", "a:1 (norm)", std::sqrt(30.0)},
               {"a:1:3", "a:1:3", 3}};
  for (const auto& [by, name, value] : found) {
    const NamedField field = shown_field(by, fields, 2, "a.vtu");
    EXPECT_EQ(field.name, name) << by;
    EXPECT_NEAR(field.values.at(0), value, 1e-15) << by;
  }
  for (const char* by : {"w", "0", "5", "v:3", "v:0", "u:2", ":1", "v:", ""})
    EXPECT_THROW(shown_field(by, fields, 2, "a.vtu"), UsageError) << by;
}

TEST(Camera, HasOrthonormalAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    const Camera camera = camera_along(axis);
    EXPECT_NEAR(dot(camera.right, camera.up), 0, 1e-15);
    EXPECT_NEAR(dot(camera.right, camera.towards), 0, 1e-15);
    EXPECT_NEAR(norm(camera.up), 1, 1e-15);
    EXPECT_GT(camera.up[2], 0);
  }
}

TEST(Colours, GoFromOneEndToTheOther) {
  EXPECT_EQ(quality_colour(-1), quality_colour(0));
  EXPECT_EQ(quality_colour(2), quality_colour(1));
  EXPECT_EQ(size_colour(std::nan("")), size_colour(0));
  EXPECT_EQ(reference_colour(-10), reference_colour(0));
}

// ---- Pages ----

/// The array of this name in a page, and how many bytes it has.
std::string array_of(const std::string& page, const std::string& name) {
  const std::string begin = "\"" + name + "\": \"";
  const std::size_t at = page.find(begin) + begin.size(), end = page.find('"', at);
  return page.substr(at, end - at);
}
std::size_t bytes_of(const std::string& page, const std::string& name) {
  const std::string text = array_of(page, name);
  return text.size() / 4 * 3 - static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
}

TEST(Page, HasAllOfTheMeshAndNothingFromElsewhere) {
  AnyMesh mesh = two_tetrahedra();
  mesh.names = {{2, 7, "</script><b>wall & \"door\""}};
  mesh.triangles.add({0, 2, 3}, 8);
  const std::string page = turning_page(runtime::Executor({.threads = 1}), mesh, nullptr, {});
  EXPECT_EQ(bytes_of(page, "points"), 12 * mesh.vertex_count());
  EXPECT_EQ(bytes_of(page, "elements"), 16 * mesh.tetrahedra.size());
  EXPECT_EQ(bytes_of(page, "colours"), 3 * mesh.tetrahedra.size());
  EXPECT_EQ(bytes_of(page, "listed"), 12 * mesh.triangles.size());
  EXPECT_EQ(bytes_of(page, "listedColours"), 3 * mesh.triangles.size());
  EXPECT_EQ(page.find("://"), std::string::npos);
  EXPECT_EQ(page.find("@DATA@"), std::string::npos);
  EXPECT_EQ(page.find("@CAPTION@"), std::string::npos);
  EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));  // a name does not end it
  EXPECT_NE(page.find("wall & \\\"door\\\" (7)"), std::string::npos);
}

TEST(Page, HasAFlatMeshAndASurfaceToo) {
  EXPECT_EQ(
      bytes_of(turning_page(runtime::Executor({.threads = 1}), square(), nullptr, {}), "elements"),
      24U);
  AnyMesh surface = two_tetrahedra();
  surface.tetrahedra = {};
  EXPECT_EQ(
      bytes_of(turning_page(runtime::Executor({.threads = 1}), surface, nullptr, {}), "elements"),
      12U);
  surface.triangles = {};
  EXPECT_THROW(turning_page(runtime::Executor({.threads = 1}), surface, nullptr, {}),
               meshadapt::InputError);
}

/// The colours of the scale, not of references: a page and a picture show the same.
TEST(Page, ColoursASurfaceAsItsLegendSays) {
  AnyMesh surface = box_mesh<3>({1, 1, 1}, {2, 2, 2});
  surface.tetrahedra = {};
  for (const Tint tint : {Tint::quality, Tint::size, Tint::reference}) {
    const runtime::Executor executor({.threads = 1});
    const Look look = look_at(executor, surface, nullptr, {.tint = tint});
    EXPECT_EQ(look.legends.size(), 1U);
    EXPECT_EQ(look.legends[0].tint, tint);
    std::set<std::string> colours;  // three bytes are four letters
    const std::string page = turning_page(executor, surface, nullptr, {.tint = tint});
    const std::string text = array_of(page, "colours");
    for (std::size_t at = 0; at < text.size(); at += 4) colours.insert(text.substr(at, 4));
    EXPECT_EQ(colours.size(), tint == Tint::reference ? 6U : 1U);
    EXPECT_EQ(bytes_of(page, "colours"), 3 * surface.triangles.size());
  }
}

TEST(Draw, RefusesAnSvgOfTooManyPolygons) {
  Scene scene = make_scene(runtime::Executor({.threads = 1}), square(), nullptr, {});
  scene.panels[0].faces.resize(most_svg_faces + 1);
  EXPECT_THROW(draw(scene, PictureFormat::svg, 100), meshadapt::InputError);
}

}  // namespace
}  // namespace ductile::cli::picture_test
