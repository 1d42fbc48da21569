#include "support/level_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::test {

double sphere_level(const Vector<3>& p) { return norm(p) - 1; }

double torus_level(const Vector<3>& p) {
  return std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - 0.4;
}

double gyroid_level(const Vector<3>& p) {
  constexpr double k = 2 * std::numbers::pi, thickness = 0.6;
  const double value = std::sin(k * p[0]) * std::cos(k * p[1]) +
                       std::sin(k * p[1]) * std::cos(k * p[2]) +
                       std::sin(k * p[2]) * std::cos(k * p[0]);
  return std::abs(value) - thickness;
}

double cube_level(const Vector<3>& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) - 1;
}

double plate_level(const Vector<3>& p) {
  const double beyond = std::max(0.0, std::hypot(p[0], p[1]) - 1);
  return std::hypot(beyond, p[2]) - 0.01;
}

namespace {

/// Cuts tetrahedra one by one; a shared edge is cut once.
class Cutter {
 public:
  Cutter(const LevelGrid& grid, const Level& level)
      : grid_(grid), level_(level), random_(grid.seed) {
    place_axes();
  }

  AnyMesh cut() {
    const int n = grid_.n;
    std::array<std::size_t, 3> axes{0, 1, 2};
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) do {
            std::array<int, 3> at{i, j, k};
            Corners<3> corners{};
            corners[0] = number_of(at);
            for (std::size_t s = 0; s < 3; ++s) {
              ++at[axes[s]];
              corners[s + 1] = number_of(at);
            }
            cut(corners);
          } while (std::next_permutation(axes.begin(), axes.end()));
    move_zeros();
    return mesh();
  }

 private:
  struct Zero {
    Vector<3> linear, wanted;
  };

  void place_axes() {
    for (int i = 0; i < 3; ++i) axis_[static_cast<std::size_t>(i)][i] = 2 * grid_.extent / grid_.n;
    if (grid_.seed == 0) return;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double angle = uniform(random_, -1.5, 1.5), c = std::cos(angle), s = std::sin(angle);
      for (Vector<3>& a : axis_) {
        const double u = a[i], v = a[j];
        a[i] = c * u - s * v;
        a[j] = s * u + c * v;
      }
    }
    for (const Vector<3>& a : axis_) shift_ += uniform(random_, -0.5, 0.5) * a;
  }

  std::uint32_t add_point(const Vector<3>& point, double value) {
    points_.push_back(point);
    value_.push_back(value);
    return static_cast<std::uint32_t>(points_.size() - 1);
  }

  std::uint32_t number_of(const std::array<int, 3>& at) {
    const auto found = grid_vertices_.find(at);
    if (found != grid_vertices_.end()) return found->second;
    Vector<3> p = shift_;
    for (std::size_t i = 0; i < 3; ++i) p += (at[i] - 0.5 * grid_.n) * axis_[i];
    return grid_vertices_[at] = add_point(p, level_(p));
  }

  /// The vertex at the zero between a point inside and one outside, placed by linear interpolation
  /// at first.
  std::uint32_t zero_between(std::uint32_t in, std::uint32_t out) {
    const auto found = zero_at_.find({in, out});
    if (found != zero_at_.end()) return found->second;
    double low = 0, high = 1;
    const Vector<3> from = points_[in], along = points_[out] - from;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (level_(from + middle * along) < 0 ? low : high) = middle;
    }
    constexpr double closest = 1e-5;
    const double least = std::max(closest, grid_.least);
    const double at = high + uniform(random_, -grid_.noise, grid_.noise);
    const double linear = std::clamp(value_[in] / (value_[in] - value_[out]), closest, 1.0);
    const std::uint32_t vertex = add_point(from + linear * along, 0);
    zeros_[vertex] = {points_[vertex], from + std::clamp(at, least, 1 - least) * along};
    return zero_at_[{in, out}] = vertex;
  }

  void cut(const Corners<3>& corners) {
    std::vector<std::uint32_t> in, out;
    for (const std::uint32_t v : corners) (value_[v] < 0 ? in : out).push_back(v);
    const auto zero = [&](std::size_t i, std::size_t o) { return zero_between(in[i], out[o]); };
    const std::size_t first = elements_.size();
    if (in.size() == 4) {
      elements_.push_back(corners);
    } else if (in.size() == 1) {
      elements_.push_back({in[0], zero(0, 0), zero(0, 1), zero(0, 2)});
    } else if (in.size() == 3) {
      add_prism({in[0], in[1], in[2], zero(0, 0), zero(1, 0), zero(2, 0)});
    } else if (in.size() == 2) {
      add_prism({in[0], zero(0, 0), zero(0, 1), in[1], zero(1, 0), zero(1, 1)});
    }
    for (std::size_t e = first; e < elements_.size(); ++e)
      if (volume(elements_[e]) < 0) std::swap(elements_[e][2], elements_[e][3]);
  }

  /// Adds the tetrahedra of a prism: a triangle and the one above it. The diagonals of its sides
  /// begin at the side's lowest number, so that neighbours agree (Dompierre et al., "How to
  /// subdivide pyramids, prisms, and hexahedra into tetrahedra", 1999).
  void add_prism(std::array<std::uint32_t, 6> p) {
    const auto lowest = std::min_element(p.begin(), p.end()) - p.begin();
    if (lowest >= 3) std::swap_ranges(p.begin(), p.begin() + 3, p.begin() + 3);
    std::rotate(p.begin(), p.begin() + lowest % 3, p.begin() + 3);
    std::rotate(p.begin() + 3, p.begin() + 3 + lowest % 3, p.end());
    elements_.push_back({p[0], p[3], p[4], p[5]});
    if (std::min(p[1], p[5]) < std::min(p[2], p[4])) {
      elements_.push_back({p[0], p[1], p[2], p[5]});
      elements_.push_back({p[0], p[1], p[5], p[4]});
    } else {
      elements_.push_back({p[0], p[1], p[2], p[4]});
      elements_.push_back({p[0], p[4], p[2], p[5]});
    }
  }

  double volume(const Corners<3>& corners) const {
    const auto side = [&](std::size_t i) { return points_[corners[i]] - points_[corners[0]]; };
    return dot(cross(side(1), side(2)), side(3));
  }

  /// Moves vertices to the function's zeros, except where that would invert elements.
  void move_zeros() {
    for (const auto& [vertex, zero] : zeros_) points_[vertex] = zero.wanted;
    for (bool again = true; again;) {
      again = false;
      for (const Corners<3>& corners : elements_) {
        if (volume(corners) > 0) continue;
        for (const std::uint32_t v : corners)
          if (const auto zero = zeros_.find(v);
              zero != zeros_.end() && points_[v].x != zero->second.linear.x) {
            points_[v] = zero->second.linear;
            again = true;
          }
      }
    }
  }

  AnyMesh mesh() const {
    AnyMesh mesh;
    mesh.dimension = 3;
    std::map<std::uint32_t, std::uint32_t> number;
    std::vector<bool> on_zero;
    for (Corners<3> corners : elements_) {
      for (std::uint32_t& v : corners) {
        const auto found = number.emplace(v, mesh.vertex_count());
        if (found.second) {
          mesh.coordinates.insert(mesh.coordinates.end(), points_[v].x.begin(), points_[v].x.end());
          mesh.vertex_reference.push_back(0);
          on_zero.push_back(zeros_.contains(v));
        }
        v = found.first->second;
      }
      mesh.tetrahedra.add(corners, 1);
    }
    for (const auto& [key, elements] : facet_elements<3>(mesh)) {
      if (elements.size() != 1) continue;
      const bool cut = on_zero[key[0]] && on_zero[key[1]] && on_zero[key[2]];
      mesh.triangles.add(key, cut ? 1 : 2);
    }
    return mesh;
  }

  const LevelGrid& grid_;
  const Level& level_;
  Random random_;
  std::array<Vector<3>, 3> axis_{};  // a cell's sides
  Vector<3> shift_;
  std::vector<Vector<3>> points_;
  std::vector<double> value_;
  std::map<std::array<int, 3>, std::uint32_t> grid_vertices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> zero_at_;  // [in, out]
  std::map<std::uint32_t, Zero> zeros_;
  std::vector<Corners<3>> elements_;
};

}  // namespace

AnyMesh cut_out(const LevelGrid& grid, const Level& level) { return Cutter(grid, level).cut(); }

}  // namespace ductile::meshadapt::test
