#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../report.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "extents.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/names.hpp"

namespace ductile::cli {

namespace {

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

/// The legend for the references of entities of a dimension, each of which is listed once.
Legend reference_legend(const AnyMesh& mesh, int dimension, const char* title,
                        std::vector<std::int32_t> references) {
  std::ranges::sort(references);
  references.erase(std::unique(references.begin(), references.end()), references.end());
  Legend legend{.title = title, .tint = Tint::reference, .references = std::move(references)};
  for (const std::int32_t reference : legend.references)
    legend.names.push_back(joined_names(mesh, dimension, reference));
  return legend;
}

// ---- Colours by a field: each element gets that of its value, or of the mean at its corners ----

/// The colour of values that are not on the scale: NaN and infinite ones.
constexpr Colour beyond_scale{0.80, 0.80, 0.80};

struct Range {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  bool all_finite = true;
};

Range range_of(const std::vector<double>& values) {
  Range range;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      range.all_finite = false;
      continue;
    }
    range.from = std::min(range.from, value);
    range.to = std::max(range.to, value);
  }
  if (range.from > range.to) range.from = range.to = 0;
  return range;
}

std::string title_of_field(const NamedField& field, const Range& range) {
  return field.name +
         (field.place == NamedField::Place::vertices ? ", at vertices" : ", on elements") +
         format(": %.5g", range.from) +
         (range.from == range.to ? "" : format(" to %.5g", range.to)) +
         (range.all_finite ? "" : "; grey: infinite");
}

Colour colour_in(const Range& range, double value) {
  if (!std::isfinite(value)) return beyond_scale;
  if (range.from == range.to) return size_colour(0.5);
  return size_colour((value / 2 - range.from / 2) / (range.to / 2 - range.from / 2));
}

double mean_of(const NamedField& field, std::span<const std::uint32_t> corners) {
  double mean = 0;
  for (const std::uint32_t v : corners)
    mean += field.values[v] / static_cast<double>(corners.size());
  return mean;
}

Tinting tint_by_field(const AnyMesh& mesh, const NamedField& field) {
  const Range range = range_of(field.values);
  Tinting result;
  result.legend = {.title = title_of_field(field, range),
                   .tint = Tint::field,
                   .from = range.from,
                   .to = range.to};
  const bool at_vertices = field.place == NamedField::Place::vertices;
  const auto add_all = [&](const auto& cells) {
    for (std::size_t e = 0; e < cells.size(); ++e)
      result.colour_of.push_back(
          colour_in(range, at_vertices ? mean_of(field, cells.vertices[e]) : field.values[e]));
  };
  element_dimension(mesh) == 2 ? add_all(mesh.triangles) : add_all(mesh.tetrahedra);
  // The field outlives the tinting, see SceneOptions.
  result.facet_colour = [&field, range, at_vertices](std::span<const std::uint32_t> corners,
                                                     std::size_t element) {
    return colour_in(range, at_vertices ? mean_of(field, corners) : field.values[element]);
  };
  return result;
}

/// Faint, so that ellipses are seen.
Tinting no_tint(const AnyMesh& mesh) {
  return {.colour_of = std::vector<Colour>(element_count(mesh), Colour{0.97, 0.97, 0.97})};
}

Point point(const AnyMesh& mesh, std::uint32_t vertex) {
  const double* x = &mesh.coordinates[std::size_t{vertex} * 2];
  return {x[0], x[1]};
}

/// The ends of an edge, lower first, and the reference of a triangle beside it.
using Side = std::pair<std::pair<std::uint32_t, std::uint32_t>, std::int32_t>;

std::vector<Side> all_sides(const AnyMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles.vertices[t];
    for (std::size_t i = 0; i < 3; ++i)
      sides.push_back({std::minmax(v[i], v[(i + 1) % 3]), mesh.triangles.reference[t]});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
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

Tinting tint_elements(const runtime::Executor& executor, const AnyMesh& mesh,
                      const AnyField* metric, Tint tint) {
  const auto& references =
      element_dimension(mesh) == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference;
  if (tint == Tint::size && !references.empty()) return tint_by_size(mesh, references.size());
  Tinting result;
  result.legend.tint = tint;
  if (tint == Tint::reference) {
    result.legend = reference_legend(mesh, element_dimension(mesh), "elements", references);
    for (const std::int32_t reference : references)
      result.colour_of.push_back(reference_colour(reference));
  } else {
    result.legend.title = metric ? "quality in the metric (1 is ideal)" : "quality (1 is ideal)";
    for (const double quality : element_qualities(executor, mesh, metric))
      result.colour_of.push_back(quality_colour(quality));
  }
  return result;
}

namespace {

/// By what the options ask for.
Tinting tinting_of(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
                   const SceneOptions& options) {
  if (options.tint == Tint::metric) return no_tint(mesh);
  if (options.tint == Tint::field) return tint_by_field(mesh, *options.field);
  Tinting tinting = tint_elements(executor, mesh, metric, options.tint);
  if (is_surface(mesh) && options.tint != Tint::reference)
    tinting.facet_colour = [colour_of = tinting.colour_of](std::span<const std::uint32_t>,
                                                           std::size_t element) {
      return colour_of[element];
    };
  return tinting;
}

}  // namespace

Look look_at(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
             const SceneOptions& options) {
  if (mesh.triangles.size() == 0 && mesh.tetrahedra.size() == 0)
    throw InputError(mesh.name +
                     ": expected triangles or tetrahedra to draw, found neither; give "
                     "a mesh with some");
  const bool in_plane = mesh.dimension == 2, shows_metric = options.tint == Tint::metric;
  if (shows_metric && is_surface(mesh))
    throw InputError(mesh.name +
                     ": expected tetrahedra, which a metric is shown in a cut through, "
                     "found none; give a mesh with some");
  Look look{.caption = caption_of(mesh), .tinting = tinting_of(executor, mesh, metric, options)};
  look.axis = in_plane ? 2 : options.cut_axis < 0 ? thinnest_axis(mesh) : options.cut_axis;
  const bool by_reference = !in_plane && !look.tinting.facet_colour;
  const Legend listed = reference_legend(mesh, 2, "surface", mesh.triangles.reference);
  if (by_reference && listed.references.size() > 1) look.legends.push_back(listed);
  if (!shows_metric && !(by_reference && mesh.tetrahedra.size() == 0))
    look.legends.push_back(look.tinting.legend);
  return look;
}

Scene make_scene(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField* metric,
                 const SceneOptions& options) {
  const Look look = look_at(executor, mesh, metric, options);
  const AnyField* const shown = options.tint == Tint::metric ? metric : nullptr;
  Scene scene{.caption = look.caption, .panels = {}, .legends = look.legends};
  if (mesh.dimension == 2) {
    scene.panels.push_back(panel_2d(mesh, look.tinting.colour_of));
    if (shown) add_ellipses_2d(scene, mesh, *shown);
    return scene;
  }
  const Camera camera = camera_along(look.axis);
  scene.panels.push_back(surface_panel(mesh, camera, look.tinting.facet_colour));
  if (mesh.tetrahedra.size() > 0)
    scene.panels.push_back(cut_panel(mesh, look.tinting.colour_of, camera, look.axis));
  if (shown) add_ellipses_3d(scene, mesh, *shown, camera, look.axis);
  return scene;
}

Panel panel_2d(const AnyMesh& mesh, const std::vector<Colour>& colour_of) {
  Panel panel;
  panel.faces.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles.vertices[t];
    panel.faces.push_back(
        {{point(mesh, v[0]), point(mesh, v[1]), point(mesh, v[2])}, 3, colour_of[t]});
  }
  // Lines where a triangle has no neighbour or one of another reference, and where one is listed.
  const std::vector<Side> sides = all_sides(mesh);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool paired = i + 1 < sides.size() && sides[i].first == sides[i + 1].first;
    if (!paired || sides[i].second != sides[i + 1].second)
      panel.lines.push_back(
          {point(mesh, sides[i].first.first), point(mesh, sides[i].first.second)});
    if (paired) ++i;
  }
  for (const auto& edge : mesh.edges.vertices)
    panel.lines.push_back({point(mesh, edge[0]), point(mesh, edge[1])});
  return panel;
}

}  // namespace ductile::cli
