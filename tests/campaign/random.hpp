/// @file
/// Random: numbers from a seed, the same with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>

#include "geometry.hpp"

namespace ductile::campaign {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15U + 1) {
    engine_.discard(16);
  }

  std::uint64_t bits() { return engine_(); }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// 10 to a power between the two.
  double power(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  int below(int limit) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(limit)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool chance(double share) { return unit() < share; }
  template <class T>
  T pick(std::initializer_list<T> list) {
    return list.begin()[below(static_cast<int>(list.size()))];
  }
  double normal() {
    const double u = 1 - unit();
    return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * unit());
  }
  Point point() { return {unit(), unit(), unit()}; }
  /// Random right-handed orthonormal axes; in 2D the last one is z.
  std::array<Point, 3> axes(int dimension) {
    if (dimension == 2) {
      const double turn = uniform(0, 6.283185307179586);
      return {Point{std::cos(turn), std::sin(turn), 0}, Point{-std::sin(turn), std::cos(turn), 0},
              Point{0, 0, 1}};
    }
    Point a = {normal(), normal(), normal()};
    a = (1 / norm(a)) * a;
    Point b = {normal(), normal(), normal()};
    b = b - dot(a, b) * a;
    b = (1 / norm(b)) * b;
    return {a, b, cross(a, b)};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace ductile::campaign
