/// @file
/// Divides curved simplices into flat ones, so finely that these are close to them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/curved_simplex.hpp"

namespace ductile::meshadapt {

/// Into at most this many along each side.
constexpr std::uint8_t most_divisions = 8;

/// A flat part of a curved simplex.
template <int Dim, std::size_t Corners>
struct DividedPart {
  std::array<Vector<Dim>, Corners> corner;
  /// [corner], its weights in the curved simplex, in parts of `most_divisions`.
  std::array<std::array<std::uint8_t, Corners>, Corners> weight;
};

template <int Dim, std::size_t Corners>
class Divider {
 public:
  using Curved = CurvedSimplex<Dim, Corners>;
  using Part = DividedPart<Dim, Corners>;

  /// Sides are divided until they are within this distance, or `most_divisions` are reached.
  Divider(const Curved& curved, double within) : curved_(curved) {
    for (std::size_t i = 0; i < Corners; ++i)
      for (std::size_t j = 0; j < Corners; ++j) {
        std::uint8_t& n = divisions_[i][j] = 1;
        if (i == j) continue;
        const double bend = 0.75 * curved.bend(i, j);
        while (n < most_divisions && bend > within * n * n) n *= 2;
        finest_ = std::max(finest_, n);
      }
  }

  std::size_t count() const {
    const std::size_t n = finest_;
    return Corners == 2 ? n : n * n;
  }

  /// Calls visit(part) for each part, turned as the whole is.
  void each(auto&& visit) const {
    const int n = finest_;
    if constexpr (Corners == 2) {
      for (int i = 0; i < n; ++i) visit(part({std::array{n - i, i}, std::array{n - i - 1, i + 1}}));
    } else {
      const auto at = [n](int i, int j) { return std::array{n - i - j, i, j}; };
      for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
          visit(part({at(i, j), at(i + 1, j), at(i, j + 1)}));
          if (i + j + 1 < n) visit(part({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}));
        }
    }
  }

 private:
  using Weights = typename Curved::Weights;
  using Place = std::array<int, Corners>;

  Part part(const std::array<Place, Corners>& places) const {
    Part part;
    for (std::size_t i = 0; i < Corners; ++i) {
      part.corner[i] = point(places[i]);
      for (std::size_t k = 0; k < Corners; ++k)
        part.weight[i][k] = static_cast<std::uint8_t>(places[i][k] * (most_divisions / finest_));
    }
    return part;
  }

  /// On a side that its neighbour divides less it is on what the neighbour has there.
  Vector<Dim> point(const Place& place) const {
    for (std::size_t i = 0; i < Corners; ++i)
      if (place[i] == finest_) return curved_.corner(i);
    for (std::size_t i = 0; i < Corners; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (place[i] + place[j] == finest_) return on_side(i, j, place[j]);
    Weights w;
    for (std::size_t i = 0; i < Corners; ++i) w[i] = static_cast<double>(place[i]) / finest_;
    return curved_.at(w);
  }

  Vector<Dim> on_side(std::size_t i, std::size_t j, int towards_j) const {
    const int step = finest_ / divisions_[i][j], rest = towards_j % step;
    const auto at = [&](int place) {
      if (place == 0) return curved_.corner(i);
      if (place == finest_) return curved_.corner(j);
      Weights w{};
      w[j] = static_cast<double>(place) / finest_;
      w[i] = 1 - w[j];
      return curved_.at(w);
    };
    const Vector<Dim> before = at(towards_j - rest);
    if (rest == 0) return before;
    const Vector<Dim> after = at(towards_j - rest + step);
    return before + (static_cast<double>(rest) / step) * (after - before);
  }

  const Curved& curved_;
  std::array<std::array<std::uint8_t, Corners>, Corners> divisions_{};  // [corner][corner]
  std::uint8_t finest_ = 1;
};

}  // namespace ductile::meshadapt
