/// @file
/// Lanes: numbers of eight elements side by side. Loops over them have no branches and a fixed
/// length, so that the compiler vectorises them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <functional>

#include "ductile/meshadapt/metric.hpp"

namespace ductile::meshadapt {

inline constexpr std::size_t lane_count = 8;
template <class Number>
using LanesIn = std::array<Number, lane_count>;
using Lanes = LanesIn<double>;        ///< one number for each of eight elements
using QualityLanes = LanesIn<float>;  ///< their qualities, in the mesh's precision
template <int Size>
using LanesOf = std::array<Lanes, Size>;  ///< a vector or tensor for each element

/// The tensor of one lane.
template <int Dim>
[[gnu::always_inline]] inline Metric<Dim> tensor_at(const LanesOf<Metric<Dim>::size>& lanes,
                                                    std::size_t l) {
  Metric<Dim> tensor;
  for (std::size_t i = 0; i < lanes.size(); ++i) tensor.m[i] = lanes[i][l];
  return tensor;
}

/// 1 in the first lanes, 0 in those after them.
inline QualityLanes first_lanes(std::size_t count) {
  static constexpr std::array<float, 2 * lane_count> steps{1, 1, 1, 1, 1, 1, 1, 1};
  QualityLanes lanes;
  std::copy_n(steps.begin() + (lane_count - std::min(count, lane_count)), lane_count,
              lanes.begin());
  return lanes;
}

/// Reduces all lanes by joining pairs.
template <class Number>
Number folded(LanesIn<Number> lanes, auto&& join) {
  for (std::size_t half = lane_count / 2; half > 0; half /= 2)
    for (std::size_t l = 0; l < half; ++l) lanes[l] = join(lanes[l], lanes[l + half]);
  return lanes[0];
}
template <class Number>
Number total(const LanesIn<Number>& lanes) {
  return folded(lanes, std::plus<>());
}
/// least() and the next may ignore NaNs.
template <class Number>
Number least(const LanesIn<Number>& lanes) {
  return folded(lanes, [](Number a, Number b) { return a < b ? a : b; });
}
template <class Number>
Number greatest(const LanesIn<Number>& lanes) {
  return folded(lanes, [](Number a, Number b) { return a > b ? a : b; });
}

/// Transposes: the numbers `at` to `at` + 3 of eight objects made of doubles become the lanes to[0]
/// to to[3]; null is skipped. Numbers move in groups of four, because loading four at once after
/// storing single ones would stall.
template <class Object>
[[gnu::always_inline]] inline void transpose(const std::array<const Object*, lane_count>& from,
                                             std::size_t at, const std::array<Lanes*, 4>& to) {
  using Four = double __attribute__((vector_size(4 * sizeof(double))));
  for (std::size_t l = 0; l < lane_count; l += 4) {
    std::array<Four, 4> row;
    for (std::size_t i = 0; i < 4; ++i)
      std::memcpy(&row[i], reinterpret_cast<const double*>(from[l + i]) + at, sizeof(Four));
    const Four even_low = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
    const Four odd_low = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
    const Four even_high = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
    const Four odd_high = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    const std::array<Four, 4> column{__builtin_shufflevector(even_low, even_high, 0, 1, 4, 5),
                                     __builtin_shufflevector(odd_low, odd_high, 0, 1, 4, 5),
                                     __builtin_shufflevector(even_low, even_high, 2, 3, 6, 7),
                                     __builtin_shufflevector(odd_low, odd_high, 2, 3, 6, 7)};
    for (std::size_t i = 0; i < 4; ++i)
      if (to[i] != nullptr) std::memcpy(to[i]->data() + l, &column[i], sizeof(Four));
  }
}

}  // namespace ductile::meshadapt
