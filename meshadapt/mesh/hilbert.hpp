/// @file
/// hilbert_key: where a point lies along a Hilbert curve through a box. What is near along the
/// curve is near in space.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Box {
  Vector<Dim> low, high;

  /// Contains nothing.
  static Box empty() {
    Box box;
    box.low.x.fill(std::numeric_limits<double>::infinity());
    box.high.x.fill(-std::numeric_limits<double>::infinity());
    return box;
  }

  friend Box join(Box a, const Box& b) {
    for (int i = 0; i < Dim; ++i) {
      a.low[i] = std::min(a.low[i], b.low[i]);
      a.high[i] = std::max(a.high[i], b.high[i]);
    }
    return a;
  }
};

/// Position along the Hilbert curve of a cell given by `bits` bits an axis (Skilling, AIP Conf.
/// Proc. 707, 2004): coordinates are transposed in place, then interleaved.
template <std::size_t Dim>
constexpr std::uint64_t hilbert_key(std::array<std::uint32_t, Dim> x, int bits) {
  const std::uint32_t top = 1U << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1U)
    for (std::size_t i = 0; i < Dim; ++i) {
      if (x[i] & q) {
        x[0] ^= q - 1;
      } else {
        const std::uint32_t t = (x[0] ^ x[i]) & (q - 1);
        x[0] ^= t;
        x[i] ^= t;
      }
    }
  for (std::size_t i = 1; i < Dim; ++i) x[i] ^= x[i - 1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1U)
    if (x[Dim - 1] & q) t ^= q - 1;
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (std::size_t i = 0; i < Dim; ++i) key = key << 1U | (((x[i] ^ t) >> bit) & 1U);
  return key;
}

/// How the curve runs in a square: in which cells of 16 x 16 it arrives in which order, and how it
/// runs in each of them.
class HilbertTable {
 public:
  static constexpr int step = 4;  // bits an axis
  static constexpr unsigned states = 16;

  constexpr HilbertTable() {
    for (unsigned state = 0; state < states; ++state)
      for (unsigned cell = 0; cell < cells; ++cell)
        entry_[state * cells + cell] = walk(state, cell);
  }

  /// The place along the curve of a cell of a square of this state; the state of the cell.
  struct Place {
    unsigned place, state;
  };
  constexpr Place of(unsigned state, unsigned x, unsigned y) const {
    const unsigned entry = entry_[state * cells + (x << step | y)];
    return {entry % cells, entry / cells};
  }

 private:
  static constexpr unsigned cells = 1U << (2 * step);

  /// hilbert_key() for the bits of one cell. A state says what it did to those below: bit 0, the
  /// axes were exchanged; 1 and 2, then they were turned; 3, its `t`.
  static constexpr std::uint16_t walk(unsigned state, unsigned cell) {
    unsigned exchanged = state & 1U, turned[2] = {state >> 1U & 1U, state >> 2U & 1U};
    unsigned t = state >> 3U, place = 0;
    for (int bit = step - 1; bit >= 0; --bit) {
      const unsigned raw[2] = {cell >> (step + bit) & 1U, cell >> bit & 1U};
      const unsigned x = raw[exchanged] ^ turned[0], y = raw[exchanged ^ 1U] ^ turned[1];
      place = place << 2U | (x ^ t) << 1U | (x ^ y ^ t);
      t ^= x ^ y;
      turned[0] ^= x ^ y;
      if (y == 0) {
        exchanged ^= 1U;
        std::swap(turned[0], turned[1]);
      }
    }
    return static_cast<std::uint16_t>(
        (t << 3U | turned[1] << 2U | turned[0] << 1U | exchanged) * cells + place);
  }

  std::array<std::uint16_t, std::size_t{states} * cells> entry_{};
};
inline constexpr HilbertTable hilbert_table;

/// The same in 2D by table; `bits` is a multiple of its step.
inline std::uint64_t hilbert_key(std::array<std::uint32_t, 2> x, int bits) {
  constexpr int step = HilbertTable::step;
  constexpr unsigned mask = (1U << step) - 1;
  HilbertTable::Place at{0, 0};
  std::uint64_t key = 0;
  for (int left = bits - step; left >= 0; left -= step) {
    at = hilbert_table.of(at.state, x[0] >> left & mask, x[1] >> left & mask);
    key = key << (2 * step) | at.place;
  }
  return key;
}

/// Bits of the key of a point.
template <int Dim>
inline constexpr unsigned hilbert_bits = Dim == 2 ? 48 : 60;
static_assert(hilbert_bits<2> / 2 % HilbertTable::step == 0);

/// The same of a point in the box.
template <int Dim>
std::uint64_t hilbert_key(const Vector<Dim>& point, const Box<Dim>& box) {
  constexpr int bits = hilbert_bits<Dim> / Dim;
  std::array<std::uint32_t, Dim> cell{};
  for (int i = 0; i < Dim; ++i) {
    const double width = std::max(box.high[i] - box.low[i], std::numeric_limits<double>::min());
    const double at = (point[i] - box.low[i]) / width;
    cell[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(at * ((1U << bits) - 1));
  }
  return hilbert_key(cell, bits);
}

}  // namespace ductile::meshadapt
