/// @file
/// Scene: a mesh turned into coloured polygons in the plane, in the order in which they are to be
/// painted, with the text around them. It is independent of the library that paints it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "camera.hpp"
#include "colours.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::cli {

/// A convex polygon of three or four corners.
struct Face {
  std::array<Point, 4> corner;
  int corners = 3;
  Colour colour;
};

struct Line {
  Point a, b;
};

/// The points centre + cos t u + sin t v.
struct Ellipse {
  Point centre, u, v;
  Colour colour;
};

/// One drawing: faces from back to front, then lines and ellipses on top. Lines between faces are
/// faint if there are ellipses.
struct Panel {
  std::string title{};
  std::vector<Face> faces{};
  std::vector<Line> lines{};
  std::vector<Ellipse> ellipses{};
};

/// The quantity that colours elements; a metric is shown by its ellipses.
enum class Tint { quality, size, reference, field, metric };

/// The meaning of the colours: a scale (quality from 0 to 1, size and metric from `from` to `to`,
/// logarithmic, a field likewise, but even) or, for references, a list.
struct Legend {
  std::string title{};
  Tint tint = Tint::quality;
  double from = 0, to = 1;
  std::vector<std::int32_t> references{};
  std::vector<std::string> names{};  ///< [index into references], empty: it has none
};

struct Scene {
  std::string caption;
  std::vector<Panel> panels;
  std::vector<Legend> legends;

  std::size_t face_count() const;
};

struct SceneOptions {
  Tint tint = Tint::quality;
  int cut_axis = -1;  ///< normal of the cut through the middle: 0, 1, 2; -1: chosen by the shape
  const NamedField* field = nullptr;  ///< for Tint::field: scalars of this mesh
};

/// `metric` as in measure(): it says what quality means; null for Euclidean. For Tint::metric it is
/// what is drawn. Throws InputError if there is nothing to draw.
Scene make_scene(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
                 const SceneOptions& options);

// ---- For the two kinds of scenes ----

/// The colour of a facet with these corners, seen from outside, that belongs to this element.
using FacetColour =
    std::function<Colour(std::span<const std::uint32_t> corners, std::size_t element)>;

/// The colour of each element, [element], and the legend for it.
struct Tinting {
  std::vector<Colour> colour_of{};
  Legend legend{};
  FacetColour facet_colour{};  ///< of the surface; none: by reference
};

/// How a mesh is shown, in a picture or on a page.
struct Look {
  std::string caption;
  Tinting tinting;
  std::vector<Legend> legends{};  ///< without that of ellipses
  int axis = 2;                   ///< of the cut
};
Look look_at(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
             const SceneOptions& options);

Panel panel_2d(const AnyMesh& mesh, const std::vector<Colour>& colour_of);

/// The surface, in the colours of its references if none are given, seen from outside.
Panel surface_panel(const AnyMesh& mesh, const Camera& camera, const FacetColour& colour = {});

/// The part behind a plane through the middle, and the elements that the plane cuts.
Panel cut_panel(const AnyMesh& mesh, const std::vector<Colour>& colour_of, const Camera& camera,
                int axis);

/// Adds the unit ellipses of a metric at vertices, and the legend for them; of a solid, those in
/// which the plane through the middle cuts the unit ellipsoids.
void add_ellipses_2d(Scene& scene, const AnyMesh& mesh, const AnyField& metric);
void add_ellipses_3d(Scene& scene, const AnyMesh& mesh, const AnyField& metric,
                     const Camera& camera, int axis);

/// Puts the ends of a logarithmic scale apart if they are about the same.
void widen(Legend& legend);

}  // namespace ductile::cli
