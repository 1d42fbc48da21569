#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include "../files.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "extents.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;

/// Edge of the regular element with the same area or volume.
double size_of(const AnyMesh& mesh, std::size_t element) {
  if (element_dimension(mesh) == 2)
    return std::sqrt(measure(mesh, mesh.triangles.vertices[element]) * 4 / std::sqrt(3.0));
  return std::cbrt(measure(mesh, mesh.tetrahedra.vertices[element]) * 6 * std::sqrt(2.0));
}

Tinting tint_by_size(const AnyMesh& mesh, std::size_t elements) {
  std::vector<double> size(elements);
  for (std::size_t e = 0; e < elements; ++e) size[e] = size_of(mesh, e);
  std::vector<double> sorted = size;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    return std::max(sorted[static_cast<std::size_t>(share * static_cast<double>(elements - 1))],
                    1e-300);
  };
  Tinting result{
      .legend = {.title = "size of the elements (edge of the regular one of the same " +
                          std::string(element_dimension(mesh) == 2 ? "area)" : "volume)"),
                 .tint = Tint::size,
                 .from = at(0.005),
                 .to = at(0.995)}};
  widen(result.legend);
  const double range = std::log(result.legend.to / result.legend.from);
  for (const double s : size)
    result.colour_of.push_back(
        size_colour(std::log(std::max(s, 1e-300) / result.legend.from) / range));
  return result;
}

std::string caption_of(const AnyMesh& mesh) {
  const std::size_t slash = mesh.name.find_last_of('/');
  std::string caption = mesh.name.substr(slash == std::string::npos ? 0 : slash + 1) + ": " +
                        with_commas(mesh.vertex_count()) + " vertices, " +
                        with_commas(mesh.triangles.size()) + " triangles";
  if (mesh.tetrahedra.size() > 0)
    caption += ", " + with_commas(mesh.tetrahedra.size()) + " tetrahedra";
  return caption;
}

struct Look {
  const Tinting& tinting;
  const AnyField* metric;  ///< to draw ellipses of; null: none
  int axis;                ///< of the cut
};

/// [reference] the name of entities of a dimension; empty if they have none.
std::vector<std::string> names_of_references(const AnyMesh& mesh, int dimension,
                                             const std::vector<std::int32_t>& references) {
  std::vector<std::string> names(references.size());
  for (std::size_t i = 0; i < references.size(); ++i)
    for (const meshadapt::ReferenceName& name : mesh.names)
      if (name.dimension == dimension && name.reference == references[i]) names[i] = name.name;
  return names;
}

void add_solid(Scene& scene, const AnyMesh& mesh, const Look& look) {
  const Camera camera = camera_along(look.axis);
  scene.panels.push_back(surface_panel(mesh, camera, look.tinting.facet_colour));
  const std::vector<std::int32_t> references = distinct(mesh.triangles.reference);
  if (references.size() > 1 && !look.tinting.facet_colour)
    scene.legends.push_back({.title = "surface",
                             .tint = Tint::reference,
                             .references = references,
                             .names = names_of_references(mesh, 2, references)});
  if (mesh.tetrahedra.size() > 0)
    scene.panels.push_back(cut_panel(mesh, look.tinting.colour_of, camera, look.axis));
  else if (!look.tinting.facet_colour)
    return;
  if (look.metric)
    add_ellipses_3d(scene, mesh, *look.metric, camera, look.axis);
  else
    scene.legends.push_back(look.tinting.legend);
}

/// Faint, so that ellipses are seen.
Tinting no_tint(const AnyMesh& mesh) {
  const std::size_t elements =
      element_dimension(mesh) == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  return {.colour_of = std::vector<Colour>(elements, Colour{0.97, 0.97, 0.97})};
}

}  // namespace

std::size_t Scene::face_count() const {
  std::size_t count = 0;
  for (const Panel& panel : panels) count += panel.faces.size();
  return count;
}

void widen(Legend& legend) {
  if (legend.to >= 1.02 * legend.from) return;
  legend.from /= 1.1;
  legend.to *= 1.1;
}

std::vector<std::int32_t> distinct(std::vector<std::int32_t> references) {
  std::sort(references.begin(), references.end());
  references.erase(std::unique(references.begin(), references.end()), references.end());
  return references;
}

Tinting tint_elements(const runtime::Executor& executor, const AnyMesh& mesh,
                      const AnyField* metric, Tint tint) {
  const auto& references =
      element_dimension(mesh) == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference;
  if (tint == Tint::size && !references.empty()) return tint_by_size(mesh, references.size());
  Tinting result;
  result.legend.tint = tint;
  if (tint == Tint::reference) {
    result.legend.title = "elements";
    result.legend.references = distinct(references);
    result.legend.names =
        names_of_references(mesh, element_dimension(mesh), result.legend.references);
    for (const std::int32_t reference : references)
      result.colour_of.push_back(reference_colour(reference));
  } else {
    result.legend.title = metric ? "quality in the metric (1 is ideal)" : "quality (1 is ideal)";
    for (const double quality : element_qualities(executor, mesh, metric))
      result.colour_of.push_back(quality_colour(quality));
  }
  return result;
}

Tinting tinting_of(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
                   const SceneOptions& options) {
  if (options.tint == Tint::metric) return no_tint(mesh);
  if (options.tint == Tint::field) return tint_by_field(mesh, *options.field);
  return tint_elements(executor, mesh, metric, options.tint);
}

Scene make_scene(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
                 const SceneOptions& options) {
  if (mesh.triangles.size() == 0 && mesh.tetrahedra.size() == 0)
    throw meshadapt::InputError(mesh.name +
                                ": expected triangles or tetrahedra to draw, found neither; give "
                                "a mesh with some");
  const AnyField* const shown = options.tint == Tint::metric ? metric : nullptr;
  if (shown && mesh.dimension == 3 && mesh.tetrahedra.size() == 0)
    throw meshadapt::InputError(mesh.name +
                                ": expected tetrahedra, which a metric is shown in a cut through, "
                                "found none; give a mesh with some");
  Scene scene;
  scene.caption = caption_of(mesh);
  Tinting tinting = tinting_of(executor, mesh, metric, options);
  if (meshadapt::is_surface(mesh) && !tinting.facet_colour && options.tint != Tint::reference)
    tinting.facet_colour = [colour_of = tinting.colour_of](std::span<const std::uint32_t>,
                                                           std::size_t element) {
      return colour_of[element];
    };
  if (mesh.dimension == 3) {
    const int axis = options.cut_axis < 0 ? thinnest_axis(mesh) : options.cut_axis;
    add_solid(scene, mesh, {tinting, shown, axis});
    return scene;
  }
  scene.panels.push_back(panel_2d(mesh, tinting.colour_of));
  if (shown)
    add_ellipses_2d(scene, mesh, *shown);
  else
    scene.legends.push_back(tinting.legend);
  return scene;
}

}  // namespace ductile::cli
