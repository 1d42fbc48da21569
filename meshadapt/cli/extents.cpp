#include "extents.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyMesh;
using Position = meshadapt::Vector<3>;

Position position(const AnyMesh& mesh, std::uint32_t vertex) {
  const auto dim = static_cast<std::size_t>(mesh.dimension);
  const double* const x = &mesh.coordinates[vertex * dim];
  return {{x[0], x[1], dim == 3 ? x[2] : 0}};
}

/// The length, area or volume of a cell with these corners.
template <std::size_t Corners>
double size(const std::array<Position, Corners>& p) {
  const Position u = p[1] - p[0];
  if constexpr (Corners == 2)
    return norm(u);
  else if constexpr (Corners == 3)
    return norm(cross(u, p[2] - p[0])) / 2;
  else
    return std::abs(dot(u, cross(p[2] - p[0], p[3] - p[0]))) / 6;
}

double angle(const Position& u, const Position& v) {
  return std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi;
}

/// The angle of a triangle at its first corner.
double angle_at(const Position& at, const Position& a, const Position& b) {
  return angle(a - at, b - at);
}

/// The angle between the facets a b c and a b d of a tetrahedron.
double dihedral_angle(const Position& a, const Position& b, const Position& c, const Position& d) {
  return angle(cross(b - a, c - a), cross(b - a, d - a));
}

class Measuring {
 public:
  explicit Measuring(const AnyMesh& mesh) : mesh_(mesh) {}

  Extents run() {
    find_box();
    add(1, mesh_.edges, [](const auto&) {});
    add(2, mesh_.triangles, [this](const auto& p) {
      if (mesh_.dimension == 2)
        for (std::size_t i = 0; i < 3; ++i) note(angle_at(p[i], p[(i + 1) % 3], p[(i + 2) % 3]));
    });
    add(3, mesh_.tetrahedra, [this](const auto& p) {
      for (const auto& [a, b] : meshadapt::Simplex<3>::edge) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        const std::size_t k = i != 0 && j != 0 ? 0 : i != 1 && j != 1 ? 1 : 2;
        note(dihedral_angle(p[i], p[j], p[k], p[6 - i - j - k]));
      }
    });
    if (smallest_ <= largest_) {
      found_.smallest_angle = smallest_;
      found_.largest_angle = largest_;
    }
    return std::move(found_);
  }

 private:
  void find_box() {
    const auto dim = static_cast<std::size_t>(mesh_.dimension);
    for (std::size_t i = 0; i < mesh_.coordinates.size(); ++i) {
      double &low = found_.low[i % dim], &high = found_.high[i % dim];
      low = i < dim ? mesh_.coordinates[i] : std::min(low, mesh_.coordinates[i]);
      high = i < dim ? mesh_.coordinates[i] : std::max(high, mesh_.coordinates[i]);
    }
  }

  template <int Corners>
  void add(int dimension, const meshadapt::Cells<Corners>& cells, auto&& look) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::array<Position, Corners> p;
      for (std::size_t i = 0; i < p.size(); ++i) p[i] = position(mesh_, cells.vertices[c][i]);
      found_.size_of[{dimension, cells.reference[c]}] += size(p);
      look(p);
    }
  }

  void note(double angle) {
    smallest_ = std::min(smallest_, angle);
    largest_ = std::max(largest_, angle);
  }

  const AnyMesh& mesh_;
  Extents found_;
  double smallest_ = std::numeric_limits<double>::infinity(), largest_ = -smallest_;
};

}  // namespace

double Extents::total(int dimension) const {
  double sum = 0;
  for (const auto& [key, size] : size_of)
    if (key.first == dimension) sum += size;
  return sum;
}

Extents extents_of(const AnyMesh& mesh) { return Measuring(mesh).run(); }

}  // namespace ductile::cli
