#include "size_options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "io/number_in.hpp"

namespace ductile::cli {

namespace {

/// True for "2", and for "2/0.5", which only a growth can be.
bool is_numeric(const std::string& text) {
  const auto parts = split(text, '/');
  return parts.size() <= 2 && std::all_of(parts.begin(), parts.end(), [](const std::string& part) {
           return number_in<double>(part).has_value();
         });
}

/// The numbers that give a place of this shape; empty if there is no such shape.
std::string numbers_of(const std::string& shape) {
  return shape == "point"    ? "X,Y,Z (X,Y in 2D)"
         : shape == "sphere" ? "X,Y,Z,R (X,Y,R in 2D)"
         : shape == "box"    ? "two corners, X,Y,Z,X,Y,Z (X,Y,X,Y in 2D)"
         : shape == "line"   ? "points, X,Y,Z,X,Y,Z,... (X,Y,X,Y,... in 2D)"
         : shape == "file"   ? "the name of a mesh"
                             : "";
}

[[noreturn]] void refuse(const std::string& words, const std::string& expected) {
  throw UsageError("option " + words + ": expected " + expected);
}

/// Reads H[:GROW[:HMAX]] or H:HMAX/DISTANCE.
void read_growth(const std::string& all, const std::vector<std::string>& fields, double& size,
                 SizeGrowth& growth) {
  const auto is_size = [](double x) { return x >= smallest_size && x <= largest_size; };
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
SizePlace place_in(const AnyMesh& file, const AnyMesh& mesh, const std::string& all) {
  if (file.dimension != mesh.dimension)
    refuse(all, "a mesh of dimension " + std::to_string(mesh.dimension) +
                    ", not flat, found one of " + std::to_string(file.dimension));
  TriangleSurface surface;
  surface.points = points_of(file.coordinates, static_cast<std::size_t>(file.dimension));
  if (mesh.dimension == 3) surface.triangles = file.triangles.vertices;
  if (surface.triangles.empty())
    for (const auto& [a, b] : file.edges.vertices) surface.triangles.push_back({a, b, b});
  if (surface.triangles.empty()) refuse(all, "a mesh with triangles or edges, found none");
  return surface;
}

}  // namespace

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t to; (to = text.find(at, from)) != std::string::npos; from = to + 1)
    parts.push_back(text.substr(from, to - from));
  parts.push_back(text.substr(from));
  return parts;
}

std::optional<double> size_option(const Arguments& arguments, std::string_view name) {
  const std::optional<double> value = arguments.positive(name);
  if (value && (*value < smallest_size || *value > largest_size))
    refuse_value(name, "a size from 1e-75 to 1e75", *arguments.text(name));
  return value;
}

SizeBounds size_bounds(const Arguments& arguments) {
  const SizeBounds bounds{size_option(arguments, "-hmin").value_or(0),
                          size_option(arguments, "-hmax").value_or(0)};
  if (bounds.largest > 0 && bounds.smallest > bounds.largest)
    throw UsageError("options -hmin and -hmax: expected -hmin to be the smaller one");
  return bounds;
}

double gradation_of(const Arguments& arguments, std::string_view option) {
  const double factor = arguments.number(option).value_or(0);
  if (factor > 0 && factor < 1)
    throw UsageError("option " + std::string(option) +
                     ": expected a factor of 1 or more, or -1 for none, found '" +
                     *arguments.text(option) + "'");
  return std::max(factor, 0.0);
}

Recovery recovery_in(const Arguments& arguments) {
  const std::string recovery = arguments.text("--recovery").value_or("least-squares");
  if (recovery == "projection") return Recovery::double_projection;
  if (recovery == "least-squares") return Recovery::least_squares;
  refuse_value("--recovery", "least-squares or projection", recovery);
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
  const std::string numbers = numbers_of(words.shape);
  if (numbers.empty())
    refuse(words.all, "point, sphere, box, line or file, found '" + words.shape + "'");
  if (words.shape == "file") return words;
  for (const std::string& text : split(words.name, ',')) {
    const auto number = number_in<double>(text);
    if (!number || !std::isfinite(*number))
      refuse(words.all, numbers + ", found '" + words.name + "'");
    words.numbers.push_back(*number);
  }
  return words;
}

std::vector<fs::path> SizeOptions::inputs() const {
  std::vector<fs::path> paths;
  for (const Words& words : words_)
    if (words.shape == "file") paths.emplace_back(words.name);
  return paths;
}

SizePlace SizeOptions::place_of(const Words& words, const AnyMesh& mesh, Warnings& warnings) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  const std::size_t count = words.numbers.size();
  const auto expect = [&](bool good) {
    if (good) return;
    refuse(words.all, numbers_of(words.shape) + " because the mesh has dimension " +
                          std::to_string(dimension) + ", found " + std::to_string(count) +
                          (count == 1 ? " number" : " numbers"));
  };
  if (words.shape == "on" || words.shape == "in") {
    const int of = words.shape == "in" ? mesh.dimension : mesh.dimension - 1;
    if (const auto reference = number_in<std::int32_t>(words.name))
      return Referenced{of, *reference};
    return Named{words.name};
  }
  if (words.shape == "file") return place_in(read_mesh(words.name, &warnings), mesh, words.all);
  const auto points = points_of(words.numbers, dimension);
  if (words.shape == "point") {
    expect(count == dimension);
    return Ball{points[0], 0};
  }
  if (words.shape == "sphere") {
    expect(count == dimension + 1);
    if (words.numbers.back() < 0) refuse(words.all, "a radius of 0 or more");
    return Ball{points[0], words.numbers.back()};
  }
  expect(words.shape == "box" ? count == 2 * dimension : count % dimension == 0);
  if (words.shape == "line") return Polyline{points};
  AxisBox box{points[0], points[1]};
  for (int axis = 0; axis < 3; ++axis)
    if (box.low[axis] > box.high[axis]) std::swap(box.low[axis], box.high[axis]);
  return box;
}

Sizes SizeOptions::sizes_for(const AnyMesh& mesh, Warnings& warnings) const {
  Sizes sizes;
  sizes.elsewhere = elsewhere_;
  for (const Words& words : words_)
    sizes.sources.push_back(
        {place_of(words, mesh, warnings), words.size, words.growth, "option " + words.all});
  return sizes;
}

}  // namespace ductile::cli
