#include "formats.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "sink.hpp"
#include "surface_of.hpp"

namespace ductile::meshadapt {
namespace {

using Point = std::array<double, 3>;

Point normal_of(const std::array<Point, 3>& p) {
  Point a, b;
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = p[1][k] - p[0][k];
    b[k] = p[2][k] - p[0][k];
  }
  Point n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  for (double& x : n) x = length > 0 && std::isfinite(length) ? x / length : 0;
  return n;
}

using Triangle = std::array<Point, 3>;

Triangle points_of(const FileSurface& surface, std::size_t triangle) {
  Triangle points;
  for (std::size_t i = 0; i < 3; ++i)
    std::copy_n(&surface.coordinates[3 * std::size_t{surface.triangles.vertices[triangle][i]}], 3,
                points[i].begin());
  return points;
}

void put_binary(Sink& sink, const FileSurface& surface) {
  std::string head = "binary STL by Ductile";
  head.resize(80, ' ');
  sink.write(head);
  sink.set_binary(std::endian::little);
  sink.put(static_cast<std::uint32_t>(surface.triangles.size()));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle points = points_of(surface, t);
    for (const double x : normal_of(points)) sink.put(static_cast<float>(x));
    for (const Point& point : points)
      for (const double x : point) sink.put(static_cast<float>(x));
    sink.put(std::uint16_t{0});
  }
}

void put_text(Sink& sink, const FileSurface& surface) {
  sink.set_text("\n");
  sink.write("solid Ductile\n");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle points = points_of(surface, t);
    sink.write("facet normal ");
    sink.record(normal_of(points));
    sink.write("outer loop\n");
    for (const Point& point : points) {
      sink.write("vertex ");
      sink.record(point);
    }
    sink.write("endloop\nendfacet\n");
  }
  sink.write("endsolid Ductile\n");
}

void expect_single(const std::vector<double>& coordinates, const std::filesystem::path& path) {
  for (const double x : coordinates)
    if (std::abs(x) > std::numeric_limits<float>::max())
      throw InputError(path.string() +
                       ": expected coordinates that single precision holds, found a larger one; "
                       "write another format");
}

}  // namespace

FileSurface surface_of(const AnyMesh& mesh, const std::filesystem::path& path) {
  expect_fit_for_file(mesh, {});
  if (mesh.dimension != 3)
    throw InputError(path.string() +
                     ": expected a mesh of dimension 3, whose surface goes there, found one of "
                     "dimension 2; write another format");
  if (mesh.tetrahedra.size() == 0) return {mesh.coordinates, mesh.triangles};
  const auto fixed = make_fixed_mesh<3>(runtime::Executor({.threads = 1}), mesh);
  FileSurface surface;
  std::vector<std::uint32_t> number_of(mesh.vertex_count(), none);
  const auto number = [&](VertexId v) {
    if (number_of[v] == none) {
      number_of[v] = static_cast<std::uint32_t>(surface.coordinates.size() / 3);
      surface.coordinates.insert(surface.coordinates.end(), &mesh.coordinates[3 * std::size_t{v}],
                                 &mesh.coordinates[3 * std::size_t{v}] + 3);
    }
    return number_of[v];
  };
  for (std::size_t element = 0; element < fixed.element_count(); ++element)
    for (int i = 0; i < 4; ++i) {
      if (fixed.neighbour_of[element][static_cast<std::size_t>(i)] != none) continue;
      Facet<3> side = facet_of<3>(fixed.corners_of[element], i);
      for (VertexId& v : side) v = number(v);
      surface.triangles.add(side, 0);
    }
  return surface;
}

void write_stl(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  const FileSurface surface = surface_of(mesh, path);
  if (surface.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(path.string() + ": too many triangles for this format; write another");
  warn_of_lost(options, path,
               mesh.tetrahedra.size() == 0 ? "references" : "references and the inside");
  const bool is_text = options.form == WriteOptions::Form::ascii;
  if (!is_text) expect_single(surface.coordinates, path);
  Sink& sink = outputs.stage(path);
  is_text ? put_text(sink, surface) : put_binary(sink, surface);
}

}  // namespace ductile::meshadapt
