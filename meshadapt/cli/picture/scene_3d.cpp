#include <algorithm>
#include <cmath>

#include "scene.hpp"

namespace ductile::cli {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// A facet of the surface, counter-clockwise seen from outside.
struct Skin {
  Triangle key;  ///< its corners, sorted
  Triangle corners;
  std::int32_t reference = 0;
  std::size_t element = 0;  ///< that it belongs to: a tetrahedron, or itself where there are none
};

/// Facets that belong to one tetrahedron only.
std::vector<Skin> facets_of_one(const AnyMesh& mesh) {
  std::vector<Skin> facets;
  facets.reserve(4 * mesh.tetrahedra.size());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    for (int i = 0; i < 4; ++i) {
      const Triangle corners = facet_of<3>(mesh.tetrahedra.vertices[e], i);
      facets.push_back({sorted(corners), corners, 0, e});
    }
  std::ranges::sort(facets, {}, &Skin::key);
  std::vector<Skin> skin;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    if (i + 1 < facets.size() && facets[i].key == facets[i + 1].key)
      ++i;
    else
      skin.push_back(facets[i]);
  }
  return skin;
}

/// The surface with the references of the triangles listed in the mesh; these are all there is to
/// draw where there are no tetrahedra.
std::vector<Skin> make_skin(const AnyMesh& mesh) {
  std::vector<Skin> listed;
  listed.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles.vertices[t];
    listed.push_back({sorted(corners), corners, mesh.triangles.reference[t], t});
  }
  if (mesh.tetrahedra.size() == 0) return listed;
  std::ranges::sort(listed, {}, &Skin::key);
  std::vector<Skin> skin = facets_of_one(mesh);
  for (Skin& facet : skin) {
    const auto found = std::ranges::lower_bound(listed, facet.key, {}, &Skin::key);
    if (found != listed.end() && found->key == facet.key) facet.reference = found->reference;
  }
  return skin;
}

/// A face and its depth.
struct DeepFace {
  double depth = 0;
  Face face;
};

std::vector<Face> back_to_front(std::vector<DeepFace> deep) {
  std::ranges::sort(deep, {}, &DeepFace::depth);
  std::vector<Face> faces(deep.size());
  std::ranges::transform(deep, faces.begin(), &DeepFace::face);
  return faces;
}

/// The brightness of a surface with this normal, lit from above the viewer's left shoulder.
double lightness(const Position& normal, const Camera& camera) {
  const Position light = camera.towards + 0.6 * camera.up + (-0.35) * camera.right;
  const double cosine = std::abs(dot(normal, light)) / (norm(normal) * norm(light));
  return 0.62 + 0.38 * cosine;
}

/// The part of a convex polygon where side(corner) <= 0.
std::vector<Position> clip(const std::vector<Position>& polygon, auto&& side) {
  std::vector<Position> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Position &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = side(a), at_b = side(b);
    if (at_a <= 0) kept.push_back(a);
    if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
      kept.push_back(a + (at_a / (at_a - at_b)) * (b - a));
  }
  return kept;
}

DeepFace project(const std::vector<Position>& polygon, const Colour& colour, const Camera& camera) {
  DeepFace deep;
  deep.face.corners = static_cast<int>(std::min<std::size_t>(4, polygon.size()));
  deep.face.colour = colour;
  for (std::size_t i = 0; i < static_cast<std::size_t>(deep.face.corners); ++i) {
    deep.face.corner[i] = camera.project(polygon[i]);
    deep.depth += camera.depth(polygon[i]) / deep.face.corners;
  }
  return deep;
}

/// The facets that are seen, each passed through `shape`, which may clip it, in colour(facet,
/// light).
std::vector<Face> visible_faces(const AnyMesh& mesh, const Camera& camera, auto&& colour,
                                auto&& shape) {
  const bool closed = mesh.tetrahedra.size() > 0;
  std::vector<DeepFace> deep;
  for (const Skin& facet : make_skin(mesh)) {
    const Position a = position_in<3>(mesh, facet.corners[0]),
                   b = position_in<3>(mesh, facet.corners[1]),
                   c = position_in<3>(mesh, facet.corners[2]);
    const Position normal = cross(b - a, c - a);
    if (norm(normal) == 0 || (closed && dot(normal, camera.towards) <= 0)) continue;
    const std::vector<Position> polygon = shape(std::vector<Position>{a, b, c});
    if (polygon.size() >= 3)
      deep.push_back(project(polygon, colour(facet, lightness(normal, camera)), camera));
  }
  return back_to_front(std::move(deep));
}

}  // namespace

Panel surface_panel(const AnyMesh& mesh, const Camera& camera, const FacetColour& colour) {
  Panel panel{.title = "surface"};
  panel.faces = visible_faces(
      mesh, camera,
      [&](const Skin& facet, double light) {
        if (!colour) return light * reference_colour(facet.reference);
        const double little = 0.7 + 0.3 * light;  // so that colours are those of the scale
        return little * colour(facet.corners, facet.element);
      },
      [](std::vector<Position> polygon) { return polygon; });
  return panel;
}

Panel cut_panel(const AnyMesh& mesh, const std::vector<Colour>& colour_of, const Camera& camera,
                int axis) {
  const CutPlane plane = middle_plane(mesh, camera, axis);
  Panel panel{.title = std::string("cut at ") + "xyz"[axis] + " = " + std::to_string(plane.at)};
  panel.title.erase(panel.title.find_last_not_of('0') + 1);
  if (panel.title.ends_with('.')) panel.title.pop_back();
  panel.faces = visible_faces(
      mesh, camera,
      [](const Skin&, double light) {
        return light * Colour{0.86, 0.86, 0.86};
      },
      [&](const std::vector<Position>& polygon) {
        return clip(polygon, [&](const Position& p) { return plane.side(p); });
      });
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const std::vector<Position> polygon = section(tetrahedron(mesh, e), plane);
    if (polygon.size() >= 3) panel.faces.push_back(project(polygon, colour_of[e], camera).face);
  }
  return panel;
}

}  // namespace ductile::cli
