#include <gtest/gtest.h>

#include <cmath>

#include "ductile/meshadapt/error.hpp"
#include "picture/draw.hpp"
#include "picture/scene.hpp"

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
  // Seen from the right, the front and above: of the six facets, the faces at y = 0 and the slanted
  // ones that look that way; never the shared one.
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
    // At x = 1/2 and y = 1/2 two triangles of area 1/8; at z = 0 the shared facet. A
    // projection shrinks it by the cosine.
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

TEST(Draw, RefusesAnSvgOfTooManyPolygons) {
  Scene scene = make_scene(runtime::Executor({.threads = 1}), square(), nullptr, {});
  scene.panels[0].faces.resize(most_svg_faces + 1);
  EXPECT_THROW(draw(scene, PictureFormat::svg, 100), meshadapt::InputError);
}

}  // namespace
}  // namespace ductile::cli::picture_test
