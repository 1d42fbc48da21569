#include "size_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "io/number_in.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyMesh;
using meshadapt::number_in;
using meshadapt::Vector;

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t to; (to = text.find(at, from)) != std::string::npos; from = to + 1)
    parts.push_back(text.substr(from, to - from));
  parts.push_back(text.substr(from));
  return parts;
}

/// True for "2", and for "2/0.5", which only a growth can be.
bool is_numeric(const std::string& text) {
  const auto parts = split(text, '/');
  return parts.size() <= 2 && std::all_of(parts.begin(), parts.end(), [](const std::string& part) {
           return number_in<double>(part).has_value();
         });
}

struct Shape {
  std::string_view name;
  std::string_view numbers;  ///< what it is given by
};
constexpr std::array<Shape, 5> shapes{{{"point", "X,Y,Z (X,Y in 2D)"},
                                       {"sphere", "X,Y,Z,R (X,Y,R in 2D)"},
                                       {"box", "two corners, X,Y,Z,X,Y,Z (X,Y,X,Y in 2D)"},
                                       {"line", "points, X,Y,Z,X,Y,Z,... (X,Y,X,Y,... in 2D)"},
                                       {"file", "the name of a mesh"}}};

[[noreturn]] void refuse(const std::string& words, const std::string& expected) {
  throw UsageError("option " + words + ": expected " + expected);
}

/// Reads H[:GROW[:HMAX]] or H:HMAX/DISTANCE.
void read_growth(const std::string& all, const std::vector<std::string>& fields, double& size,
                 meshadapt::SizeGrowth& growth) {
  const auto is_size = [](double x) {
    return x >= meshadapt::smallest_size && x <= meshadapt::largest_size;
  };
  size = number_in<double>(fields[0]).value_or(0);
  if (!is_size(size)) refuse(all, "a size from 1e-75 to 1e75, found '" + fields[0] + "'");
  if (fields.size() == 1) return;
  const auto parts = split(fields[1], '/');
  const double first = *number_in<double>(parts[0]);
  if (parts.size() == 2) {
    growth = {.largest = first, .distance = *number_in<double>(parts[1])};
    if (fields.size() > 2 || !(growth.distance > 0) || !std::isfinite(growth.distance))
      refuse(all, "H:HMAX/DISTANCE, with a distance above 0, found '" + fields[1] + "'");
  } else {
    growth.grow = first;
    if (!(first == 0 || first >= 1) || !std::isfinite(first))
      refuse(all, "a growth of 1 or more, or 0 for none, found '" + fields[1] + "'");
    if (fields.size() == 3) growth.largest = number_in<double>(fields[2]).value_or(0);
  }
  if ((parts.size() == 2 || fields.size() == 3) &&
      !(growth.largest >= size && is_size(growth.largest)))
    refuse(all, "to grow to a size of at least '" + fields[0] + "', found '" +
                    (parts.size() == 2 ? parts[0] : fields[2]) + "'");
}

/// Points from their coordinates.
std::vector<Vector<3>> points_of(const std::vector<double>& numbers, std::size_t dimension) {
  std::vector<Vector<3>> points(numbers.size() / dimension);
  for (std::size_t i = 0; i < points.size() * dimension; ++i)
    points[i / dimension].x[i % dimension] = numbers[i];
  return points;
}

/// Triangles of a file, for a mesh of dimension 3; segments otherwise, or if it has no triangles.
meshadapt::SizePlace place_in(const AnyMesh& file, const AnyMesh& mesh, const std::string& all) {
  if (file.dimension != mesh.dimension)
    refuse(all, "a mesh of dimension " + std::to_string(mesh.dimension) +
                    ", not flat, found one of " + std::to_string(file.dimension));
  meshadapt::TriangleSurface surface;
  surface.points = points_of(file.coordinates, static_cast<std::size_t>(file.dimension));
  if (mesh.dimension == 3) surface.triangles = file.triangles.vertices;
  if (surface.triangles.empty())
    for (const auto& [a, b] : file.edges.vertices) surface.triangles.push_back({a, b, b});
  if (surface.triangles.empty()) refuse(all, "a mesh with triangles or edges, found none");
  return surface;
}

}  // namespace

std::optional<double> size_option(const Arguments& arguments, std::string_view name) {
  const std::optional<double> value = arguments.positive(name);
  if (value && (*value < meshadapt::smallest_size || *value > meshadapt::largest_size))
    refuse_value(name, "a size from 1e-75 to 1e75", *arguments.text(name));
  return value;
}

SizeOptions::SizeOptions(const Arguments& arguments, std::string_view elsewhere)
    : elsewhere_(size_option(arguments, elsewhere).value_or(0)) {
  for (const char* option : {"--near", "--on", "--in", "--inside"})
    for (const std::string& value : arguments.texts(option)) words_.push_back(read(option, value));
}

SizeOptions::Words SizeOptions::read(const std::string& option, const std::string& value) {
  Words words;
  words.all = option + " " + value;
  std::vector<std::string> fields = split(value, ':');
  std::size_t named = 1;  // fields that come before the size
  if (option == "--near") {
    words.shape = fields[0];
    named = 2;
  } else {
    words.shape = option == "--on" ? "on" : "in";
  }
  // Names may have colons, so that only numbers at the end are the size and its growth.
  std::size_t first = fields.size();
  while (first > named && fields.size() - first < 3 && is_numeric(fields[first - 1])) --first;
  if (first < named || first == fields.size() || split(fields[first], '/').size() > 1)
    refuse(words.all,
           option == "--near" ? "SHAPE:WHERE:H[:GROW]" : "NAME:H[:GROW], or a number for NAME");
  read_growth(words.all, {fields.begin() + static_cast<std::ptrdiff_t>(first), fields.end()},
              words.size, words.growth);
  for (std::size_t i = named - 1; i < first; ++i)
    words.name += (i == named - 1 ? "" : ":") + fields[i];
  if (words.name.empty()) refuse(words.all, "a place, found nothing");
  if (option != "--near") return words;
  const auto shape = std::find_if(shapes.begin(), shapes.end(),
                                  [&](const Shape& one) { return one.name == words.shape; });
  if (shape == shapes.end())
    refuse(words.all, "point, sphere, box, line or file, found '" + words.shape + "'");
  if (words.shape == "file") return words;
  for (const std::string& text : split(words.name, ',')) {
    const auto number = number_in<double>(text);
    if (!number || !std::isfinite(*number))
      refuse(words.all, std::string(shape->numbers) + ", found '" + words.name + "'");
    words.numbers.push_back(*number);
  }
  return words;
}

std::vector<std::filesystem::path> SizeOptions::inputs() const {
  std::vector<std::filesystem::path> paths;
  for (const Words& words : words_)
    if (words.shape == "file") paths.emplace_back(words.name);
  return paths;
}

meshadapt::SizePlace SizeOptions::place_of(const Words& words, const AnyMesh& mesh,
                                           meshadapt::Warnings& warnings) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  const std::size_t count = words.numbers.size();
  const auto expect = [&](bool good) {
    if (good) return;
    const auto shape = std::find_if(shapes.begin(), shapes.end(),
                                    [&](const Shape& one) { return one.name == words.shape; });
    refuse(words.all, std::string(shape->numbers) + " because the mesh has dimension " +
                          std::to_string(dimension) + ", found " + std::to_string(count) +
                          (count == 1 ? " number" : " numbers"));
  };
  if (words.shape == "on" || words.shape == "in") {
    const int of = words.shape == "in" ? mesh.dimension : mesh.dimension - 1;
    if (const auto reference = number_in<std::int32_t>(words.name))
      return meshadapt::Referenced{of, *reference};
    return meshadapt::Named{words.name};
  }
  if (words.shape == "file")
    return place_in(meshadapt::read_mesh(words.name, &warnings), mesh, words.all);
  const auto points = points_of(words.numbers, dimension);
  if (words.shape == "point") {
    expect(count == dimension);
    return meshadapt::Ball{points[0], 0};
  }
  if (words.shape == "sphere") {
    expect(count == dimension + 1);
    if (words.numbers.back() < 0) refuse(words.all, "a radius of 0 or more");
    return meshadapt::Ball{points[0], words.numbers.back()};
  }
  expect(words.shape == "box" ? count == 2 * dimension : count % dimension == 0);
  if (words.shape == "line") return meshadapt::Polyline{points};
  meshadapt::AxisBox box{points[0], points[1]};
  for (int axis = 0; axis < 3; ++axis)
    if (box.low[axis] > box.high[axis]) std::swap(box.low[axis], box.high[axis]);
  return box;
}

meshadapt::Sizes SizeOptions::sizes_for(const AnyMesh& mesh, meshadapt::Warnings& warnings) const {
  meshadapt::Sizes sizes;
  sizes.elsewhere = elsewhere_;
  for (const Words& words : words_)
    sizes.sources.push_back(
        {place_of(words, mesh, warnings), words.size, words.growth, "option " + words.all});
  return sizes;
}

}  // namespace ductile::cli
