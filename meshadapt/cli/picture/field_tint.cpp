/// @file
/// Colours by a field: each element gets that of its value, or of the mean of those at its corners.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "scene.hpp"

namespace ductile::cli {

namespace {

using meshadapt::NamedField;

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

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

std::string title_of(const NamedField& field, const Range& range) {
  std::string title =
      field.name + (field.place == NamedField::Place::vertices ? ", at vertices" : ", on elements");
  title += range.from == range.to ? ": " + number(range.from)
                                  : ": " + number(range.from) + " to " + number(range.to);
  return title + (range.all_finite ? "" : "; grey: infinite");
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

}  // namespace

Tinting tint_by_field(const meshadapt::AnyMesh& mesh, const NamedField& field) {
  const Range range = range_of(field.values);
  Tinting result;
  result.legend = {
      .title = title_of(field, range), .tint = Tint::field, .from = range.from, .to = range.to};
  const bool at_vertices = field.place == NamedField::Place::vertices;
  const auto add_all = [&](const auto& cells) {
    for (std::size_t e = 0; e < cells.size(); ++e)
      result.colour_of.push_back(
          colour_in(range, at_vertices ? mean_of(field, cells.vertices[e]) : field.values[e]));
  };
  meshadapt::element_dimension(mesh) == 2 ? add_all(mesh.triangles) : add_all(mesh.tetrahedra);
  // The field outlives the tinting, see SceneOptions.
  result.facet_colour = [&field, range, at_vertices](std::span<const std::uint32_t> corners,
                                                     std::size_t element) {
    return colour_in(range, at_vertices ? mean_of(field, corners) : field.values[element]);
  };
  return result;
}

}  // namespace ductile::cli
