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

namespace ductile::meshadapt {
namespace {

/// The boundary triangles, seen from outside; without tetrahedra, all triangles.
std::vector<Facet<3>> stl_sides(const AnyMesh& mesh) {
  if (mesh.tetrahedra.size() == 0) return mesh.triangles.vertices;
  const auto fixed = make_fixed_mesh<3>(runtime::Executor({.threads = 1}), mesh);
  std::vector<Facet<3>> sides;
  for (std::size_t element = 0; element < fixed.element_count(); ++element)
    for (int i = 0; i < 4; ++i)
      if (fixed.neighbour_of[element][static_cast<std::size_t>(i)] == none)
        sides.push_back(facet_of<3>(fixed.corners_of[element], i));
  return sides;
}

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

void put_side(Sink& sink, const AnyMesh& mesh, const Facet<3>& side) {
  std::array<Point, 3> points;
  for (std::size_t i = 0; i < 3; ++i)
    std::copy_n(&mesh.coordinates[3 * std::size_t{side[i]}], 3, points[i].begin());
  for (const double x : normal_of(points)) sink.put(static_cast<float>(x));
  for (const Point& point : points)
    for (const double x : point) sink.put(static_cast<float>(x));
  sink.put(std::uint16_t{0});
}

void expect_surface(const AnyMesh& mesh, const std::filesystem::path& path) {
  if (mesh.dimension != 3)
    throw InputError(path.string() +
                     ": expected a mesh of dimension 3, whose surface goes there, found one of "
                     "dimension 2; write another format");
  for (const double x : mesh.coordinates)
    if (std::abs(x) > std::numeric_limits<float>::max())
      throw InputError(path.string() +
                       ": expected coordinates that single precision holds, found a larger one; "
                       "write another format");
}

}  // namespace

void write_stl(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  expect_fit_for_file(mesh, {});
  expect_surface(mesh, path);
  const std::vector<Facet<3>> sides = stl_sides(mesh);
  if (sides.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(path.string() + ": too many triangles for this format; write another");
  warn_of_lost(options, path, "references and the inside");
  Sink& sink = outputs.stage(path);
  std::string head = "binary STL by Ductile";
  head.resize(80, ' ');
  sink.write(head);
  sink.set_binary(std::endian::little);
  sink.put(static_cast<std::uint32_t>(sides.size()));
  for (const auto& side : sides) put_side(sink, mesh, side);
}

}  // namespace ductile::meshadapt
