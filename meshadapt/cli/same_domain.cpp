#include "same_domain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

#include "extents.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Carrying;
using meshadapt::NamedField;

/// Rounding to seven digits leaves this share of a mesh outside of an equal one.
constexpr double rounding = 1e-6;

void each_element(const AnyMesh& mesh, auto&& visit) {
  const auto all = [&](const auto& cells) {
    for (const auto& corners : cells.vertices) visit(std::span<const std::uint32_t>(corners));
  };
  mesh.dimension == 2 ? all(mesh.triangles) : all(mesh.tetrahedra);
}

/// [vertex] The longest edge of the elements around it.
std::vector<double> sizes_of(const AnyMesh& mesh) {
  std::vector<double> size_of(mesh.vertex_count());
  each_element(mesh, [&](std::span<const std::uint32_t> corners) {
    for (const std::uint32_t a : corners)
      for (const std::uint32_t b : corners)
        size_of[a] = std::max(size_of[a], norm(position(mesh, a) - position(mesh, b)));
  });
  return size_of;
}

double volume(const AnyMesh& mesh) {
  double sum = 0;
  each_element(mesh,
               [&](std::span<const std::uint32_t> corners) { sum += measure(mesh, corners); });
  return sum;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// "0.3 % of its area".
std::string share(double part, const AnyMesh& mesh) {
  return number(std::min(100.0, 100 * part / volume(mesh))) + " % of its " +
         (mesh.dimension == 2 ? "area" : "volume");
}

[[noreturn]] void refuse(const Passage& meshes, const std::string& what) {
  throw meshadapt::InputError(meshes.to.name + ": " + what + " outside of " + meshes.from.name +
                              "; give a mesh of the same domain, or --extend to take the closest " +
                              "values there");
}

void expect_vertices_inside(const Passage& meshes, const std::vector<double>& closest,
                            const std::vector<double>& size_of) {
  constexpr double most = 0.25;
  double worst = most;
  std::size_t farthest = meshes.to.vertex_count();
  const auto outside = [&](std::size_t v) {
    const auto dimension = static_cast<std::size_t>(meshes.to.dimension);
    Position gap = position(meshes.to, v);
    for (std::size_t axis = 0; axis < dimension; ++axis)
      gap.x[axis] -= closest[v * dimension + axis];
    return norm(gap);
  };
  each_element(meshes.to, [&](std::span<const std::uint32_t> corners) {
    for (const std::uint32_t v : corners)
      if (const double d = outside(v); d > worst * size_of[v]) {
        worst = d / size_of[v];
        farthest = v;
      }
  });
  if (farthest < meshes.to.vertex_count())
    refuse(meshes, "vertex " + std::to_string(farthest + 1) + " lies " + number(outside(farthest)));
}

}  // namespace

void add_probes(const AnyMesh& mesh, std::vector<NamedField>& fields,
                std::vector<Carrying>& carrying) {
  using Place = NamedField::Place;
  const bool conservative =
      std::find(carrying.begin(), carrying.end(), Carrying::conservatively) != carrying.end();
  fields.push_back({"place", AnyField::Type::vector, mesh.coordinates, Place::vertices});
  fields.push_back({"size", AnyField::Type::scalar, sizes_of(mesh), Place::vertices});
  carrying.insert(carrying.end(), 2, Carrying::by_value);
  if (conservative) return;  // so it is known how much is outside
  const std::size_t elements = mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  fields.push_back(
      {"volume", AnyField::Type::scalar, std::vector<double>(elements), Place::elements});
  carrying.push_back(Carrying::conservatively);
}

void expect_same_domain(const Passage& meshes, const meshadapt::TransferredFields& carried,
                        std::size_t first) {
  expect_vertices_inside(meshes, carried.fields[first].values, carried.fields[first + 1].values);
  if (carried.report.volume_outside > 0.01 * volume(meshes.to))
    refuse(meshes, share(carried.report.volume_outside, meshes.to) + " lies");
}

void warn_of_extension(const Passage& meshes, const meshadapt::TransferReport& report,
                       meshadapt::Warnings& warnings) {
  if (report.volume_outside > rounding * volume(meshes.to))
    warnings.push_back(meshes.to.name + ": " + share(report.volume_outside, meshes.to) +
                       " is not in " + meshes.from.name + "; values there are the closest ones");
}

void warn_of_loss(const Passage& meshes, const meshadapt::TransferReport& report,
                  meshadapt::Warnings& warnings) {
  if (report.volume_left_out > rounding * volume(meshes.from))
    warnings.push_back(meshes.from.name + ": " + share(report.volume_left_out, meshes.from) +
                       " is not in " + meshes.to.name + "; integrals lose what is there");
}

}  // namespace ductile::cli
