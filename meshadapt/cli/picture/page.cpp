#include "page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../report.hpp"
#include "extents.hpp"
#include "legend.hpp"
#include "page_template.hpp"
#include "section.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyMesh;

std::string base64(const void* data, std::size_t size) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* const bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8U | (i + k < size ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > size ? '=' : digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

template <class Value>
std::string packed(const std::vector<Value>& values) {
  return "\"" + base64(values.data(), values.size() * sizeof(Value)) + "\"";
}

std::array<std::uint8_t, 3> bytes_of(const Colour& colour) {
  const auto byte = [](double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  };
  return {byte(colour.red), byte(colour.green), byte(colour.blue)};
}

std::string css(const Colour& colour) {
  const auto [red, green, blue] = bytes_of(colour);
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "\"#%02x%02x%02x\"", red, green, blue);
  return text.data();
}

void append(std::vector<std::uint8_t>& bytes, const Colour& colour) {
  const auto three = bytes_of(colour);
  bytes.insert(bytes.end(), three.begin(), three.end());
}

/// Positions within the unit ball around the middle of the box, and that box.
struct Places {
  std::vector<float> of_vertices{};  ///< [3 vertex + axis]
  Position low, high;
};

Places places_of(const AnyMesh& mesh) {
  Places places;
  Position middle;
  double radius = 0;
  for (int k = 0; k < mesh.dimension; ++k) {
    const auto [low, high] = span_along(mesh, k);
    middle[k] = low / 2 + high / 2;
    radius = std::hypot(radius, high / 2 - low / 2);
    places.low[k] = low - middle[k];
    places.high[k] = high - middle[k];
  }
  places.low *= 1 / radius;
  places.high *= 1 / radius;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    for (const double x : (position(mesh, v) - middle).x)
      places.of_vertices.push_back(static_cast<float>(x / radius));
  return places;
}

std::string json_of(const Position& values) {
  return "[" + json_number(values[0]) + ", " + json_number(values[1]) + ", " +
         json_number(values[2]) + "]";
}

std::string json_of(const Legend& legend) {
  std::string scale = "null", items;
  const auto add = [](std::string& list, const std::string& item) {
    list += (list.empty() ? "" : ", ") + item;
  };
  if (legend.tint == Tint::reference) {
    for (std::size_t i = 0; i < legend.references.size(); ++i) {
      const bool named = i < legend.names.size() && !legend.names[i].empty();
      const std::string number = std::to_string(legend.references[i]);
      add(items, "[" + css(reference_colour(legend.references[i])) + ", " +
                     json_string(named ? legend.names[i] + " (" + number + ")" : number) + "]");
    }
  } else {
    constexpr int stops = 16;
    scale.clear();
    for (int i = 0; i <= stops; ++i)
      add(scale, css(scale_colour(legend, static_cast<double>(i) / stops)));
    scale = "[" + scale + "]";
  }
  std::array<char, 32> from, to;
  std::snprintf(from.data(), from.size(), "%.4g", legend.from);
  std::snprintf(to.data(), to.size(), "%.4g", legend.to);
  return "{\"title\": " + json_string(legend.title) + ", \"scale\": " + scale + ", \"from\": \"" +
         from.data() + "\", \"to\": \"" + to.data() + "\", \"items\": [" + items + "]}";
}

/// The elements, or the triangles where there are none in 3D, and their colours.
template <std::size_t Corners>
void pack(const std::vector<std::array<std::uint32_t, Corners>>& cells, auto&& colour_of,
          std::vector<std::uint32_t>& corners, std::vector<std::uint8_t>& colours) {
  corners.reserve(cells.size() * Corners);
  for (std::size_t e = 0; e < cells.size(); ++e) {
    corners.insert(corners.end(), cells[e].begin(), cells[e].end());
    append(colours, colour_of(e));
  }
}

std::string data_of(const AnyMesh& mesh, const Tinting& tinting, const Scene& scene, int axis) {
  const bool solid = mesh.tetrahedra.size() > 0;
  std::vector<std::uint32_t> elements, listed;
  std::vector<std::uint8_t> colours, listed_colours;
  const auto by_element = [&](std::size_t e) { return tinting.colour_of[e]; };
  const auto by_triangle = [&](std::size_t t) {
    return tinting.facet_colour ? tinting.facet_colour(mesh.triangles.vertices[t], t)
                                : reference_colour(mesh.triangles.reference[t]);
  };
  if (solid) {
    pack(mesh.tetrahedra.vertices, by_element, elements, colours);
    const auto by_reference = [&](std::size_t t) {
      return reference_colour(mesh.triangles.reference[t]);
    };
    pack(mesh.triangles.vertices, by_reference, listed, listed_colours);
  } else if (mesh.dimension == 2) {
    pack(mesh.triangles.vertices, by_element, elements, colours);
  } else {
    pack(mesh.triangles.vertices, by_triangle, elements, colours);
  }
  const Places places = places_of(mesh);
  const Camera camera = camera_along(axis);
  std::string rows, legends;
  for (const Position& row : {camera.right, camera.up, camera.towards})
    for (int k = 0; k < 3; ++k) rows += (rows.empty() ? "" : ", ") + json_number(row[k]);
  for (const Legend& legend : scene.legends)
    legends += (legends.empty() ? "" : ", ") + json_of(legend);
  const auto truth = [](bool yes) { return std::string(yes ? "true" : "false"); };
  return "{\"flat\": " + truth(mesh.dimension == 2) + ", \"solid\": " + truth(solid) +
         ", \"byReference\": " + truth(!tinting.facet_colour) + ", \"axis\": \"" + "xyz"[axis] +
         "\", \"camera\": [" + rows + "], \"low\": " + json_of(places.low) +
         ", \"high\": " + json_of(places.high) + ", \"legends\": [" + legends +
         "],\n\"points\": " + packed(places.of_vertices) + ",\n\"elements\": " + packed(elements) +
         ",\n\"colours\": " + packed(colours) + ",\n\"listed\": " + packed(listed) +
         ",\n\"listedColours\": " + packed(listed_colours) + "}";
}

/// Text as it stands in HTML.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else
      result += c;
  return result;
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
    text.replace(at, what.size(), by), at += by.size();
}

}  // namespace

std::string turning_page(const runtime::Executor& executor, const AnyMesh& mesh,
                         const meshadapt::AnyField* metric, const SceneOptions& options) {
  const Scene scene = make_scene(executor, mesh, metric, options);  // expects something to draw
  const Tinting tinting = tinting_of(executor, mesh, metric, options);
  const int axis = mesh.dimension == 2    ? 2
                   : options.cut_axis < 0 ? thinnest_axis(mesh)
                                          : options.cut_axis;
  std::string data = data_of(mesh, tinting, scene, axis);
  replace_all(data, "<", "\\u003c");  // names must not end the script
  std::string page(page_template);
  replace_all(page, "@CAPTION@", escaped(scene.caption));
  replace_all(page, "@DATA@", data);
  return page;
}

}  // namespace ductile::cli
