#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../report.hpp"
#include "draw.hpp"
#include "io/base64.hpp"
#include "legend.hpp"
#include "page_template.hpp"

namespace ductile::cli {

namespace {

template <class Value>
std::string packed(const std::vector<Value>& values) {
  std::string text;
  append_base64(text, std::as_bytes(std::span(values)));
  return text;
}

using Bytes = std::array<std::uint8_t, 3>;

Bytes bytes_of(const Colour& colour) {
  const auto byte = [](double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  };
  return {byte(colour.red), byte(colour.green), byte(colour.blue)};
}

std::string css(const Colour& colour) {
  const auto [red, green, blue] = bytes_of(colour);
  return format("#%02x%02x%02x", red, green, blue);
}

std::string packed_colours(const auto& items, auto&& colour_of) {
  std::vector<Bytes> bytes;
  bytes.reserve(items.size());
  for (const auto& item : items) bytes.push_back(bytes_of(colour_of(item)));
  return packed(bytes);
}

/// Positions within the unit ball around the middle of the box, and that box.
struct Places {
  std::vector<float> of_vertices{};  ///< [3 vertex + axis]
  Position low, high;
};

Places places_of(const AnyMesh& mesh) {
  const Box<3> box = box_of(mesh);
  Position middle;
  double radius = 0;
  for (int k = 0; k < 3; ++k) {
    middle[k] = box.low[k] / 2 + box.high[k] / 2;
    radius = std::hypot(radius, box.high[k] / 2 - box.low[k] / 2);
  }
  Places places{.low = (1 / radius) * (box.low - middle),
                .high = (1 / radius) * (box.high - middle)};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    for (const double x : (position(mesh, v) - middle).x)
      places.of_vertices.push_back(static_cast<float>(x / radius));
  return places;
}

Json to_json(const Position& values) { return json_list({values[0], values[1], values[2]}); }

Json to_json(const Legend& legend) {
  Json scale;
  std::vector<Json> items;
  if (legend.tint == Tint::reference) {
    for (std::size_t i = 0; i < legend.references.size(); ++i) {
      const bool named = i < legend.names.size() && !legend.names[i].empty();
      const std::string number = std::to_string(legend.references[i]);
      items.push_back(json_list({css(reference_colour(legend.references[i])),
                                 named ? legend.names[i] + " (" + number + ")" : number}));
    }
  } else {
    constexpr int stops = 16;
    std::vector<Json> colours;
    for (int i = 0; i <= stops; ++i)
      colours.emplace_back(css(scale_colour(legend, static_cast<double>(i) / stops)));
    scale = json_list(colours);
  }
  return json_object("title", legend.title, "scale", scale, "from", format("%.4g", legend.from),
                     "to", format("%.4g", legend.to), "items", json_list(items));
}

std::string data_of(const AnyMesh& mesh, const Look& look) {
  const bool solid = mesh.tetrahedra.size() > 0;
  const auto itself = [](const Colour& colour) { return colour; };
  const Places places = places_of(mesh);
  const Camera camera = camera_along(look.axis);
  std::vector<Json> rows, legends;
  for (const Position& row : {camera.right, camera.up, camera.towards})
    rows.insert(rows.end(), {row[0], row[1], row[2]});
  for (const Legend& legend : look.legends) legends.push_back(to_json(legend));
  const std::array<std::pair<const char*, std::string>, 5> arrays{
      {{"points", packed(places.of_vertices)},
       {"elements", solid ? packed(mesh.tetrahedra.vertices) : packed(mesh.triangles.vertices)},
       {"colours", packed_colours(look.tinting.colour_of, itself)},
       {"listed", solid ? packed(mesh.triangles.vertices) : std::string()},
       {"listedColours",
        solid ? packed_colours(mesh.triangles.reference, reference_colour) : std::string()}}};
  std::string data =
      json_object("flat", mesh.dimension == 2, "solid", solid, "byReference",
                  !look.tinting.facet_colour, "axis", std::string(1, "xyz"[look.axis]), "camera",
                  json_list(rows), "low", to_json(places.low), "high", to_json(places.high),
                  "legends", json_list(legends))
          .text;
  data.pop_back();
  for (const auto& [name, text] : arrays)
    data.append(",\n\"").append(name).append("\": \"").append(text).append("\"");
  return data + "}";
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
    text.replace(at, what.size(), by), at += by.size();
}

}  // namespace

std::string turning_page(const runtime::Executor& executor, const AnyMesh& mesh,
                         const AnyField* metric, const SceneOptions& options) {
  Look look = look_at(executor, mesh, metric, options);
  std::string data = data_of(mesh, look);
  replace_all(data, "<", "\\u003c");  // names must not end the script
  replace_all(look.caption, "&", "&amp;");
  replace_all(look.caption, "<", "&lt;");
  std::string page(page_template);
  replace_all(page, "@CAPTION@", look.caption);
  replace_all(page, "@DATA@", data);
  return page;
}

}  // namespace ductile::cli
