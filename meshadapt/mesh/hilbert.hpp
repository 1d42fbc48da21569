/// @file
/// hilbert_key: the position of a point along a Hilbert curve through a box. Points that are close
/// along the curve are close in space.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/hash.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {

/// The course of the curve through a square or cube, as a table: the order in which it visits the
/// cells of a grid, and its orientation in each.
template <int Dim>
class HilbertTable {
 public:
  static constexpr int step = Dim == 2 ? 4 : 2;  // bits per axis: 16 x 16, or 4 x 4 x 4 cells
  using Cell = std::array<std::uint32_t, Dim>;
  struct Place {
    unsigned place, state;
  };

  constexpr HilbertTable() {
    std::array<Place, std::size_t{states} << unsigned{Dim}> after_bit{};  // [state][bits]
    for (unsigned i = 0; i < after_bit.size(); ++i) after_bit[i] = pass(i >> Dim, i % corners);
    for (unsigned i = 0; i < entry_.size(); ++i) {
      Place at{0, i / cells};
      for (int bit = step - 1; bit >= 0; --bit) {
        unsigned bits = 0;
        for (int axis = Dim - 1; axis >= 0; --axis)
          bits = bits << 1U | (i >> (axis * step + bit) & 1U);
        const Place& next = after_bit[at.state << Dim | bits];
        at = {at.place << Dim | next.place, next.state};
      }
      entry_[i] = static_cast<std::uint16_t>(at.state * cells + at.place);
    }
  }

  /// The position along the curve of the cell given by these bits of coordinates, in a square of
  /// this state (0 at first), and the state in that cell.
  constexpr Place of(unsigned state, const Cell& x, int shift) const {
    unsigned cell = 0;
    for (unsigned i = Dim; i-- > 0;) cell = cell << unsigned{step} | (x[i] >> shift & (side - 1));
    const unsigned entry = entry_[state * cells + cell];
    return {entry % cells, entry / cells};
  }

 private:
  static constexpr unsigned side = 1U << step, cells = 1U << (Dim * step), corners = 1U << Dim;
  static constexpr unsigned orders = Dim == 2 ? 2 : 6, states = orders << (Dim + 1);
  static constexpr std::array<std::array<std::uint8_t, 3>, 6> axes{
      {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}}};

  /// hilbert_key() for one bit of each coordinate, the first lowest. The state encodes what
  /// happened to the bits below: which coordinates were inverted, then its `t`, then how they were
  /// exchanged.
  static constexpr Place pass(unsigned state, unsigned bits) {
    auto axis = axes[state >> (Dim + 1)];
    std::array<unsigned, Dim> turned{}, x{};
    for (unsigned i = 0; i < Dim; ++i) {
      turned[i] = state >> i & 1U;
      x[i] = (bits >> axis[i] & 1U) ^ turned[i];
    }
    unsigned t = state >> unsigned{Dim} & 1U, place = 0;
    for (unsigned i = 0; i < Dim; ++i) {
      if (x[i] != 0) {
        turned[0] ^= 1U;
      } else {
        std::swap(axis[0], axis[i]);
        std::swap(turned[0], turned[i]);
      }
    }
    for (unsigned i = 0; i < Dim; ++i) {
      if (i > 0) x[i] ^= x[i - 1];
      place = place << 1U | (x[i] ^ t);
    }
    t ^= x[Dim - 1];
    unsigned next = 0;
    while (axes[next] != axis) ++next;
    next = next << 1U | t;
    for (unsigned i = Dim; i-- > 0;) next = next << 1U | turned[i];
    return {place, next};
  }

  std::array<std::uint16_t, std::size_t{states} * cells> entry_{};
};
template <int Dim>
inline constexpr HilbertTable<Dim> hilbert_table;

/// hilbert_key() by table lookup; `bits` is a multiple of the table's step.
template <int Dim>
std::uint64_t hilbert_key_by_table(const std::array<std::uint32_t, Dim>& x, int bits) {
  constexpr int step = HilbertTable<Dim>::step;
  typename HilbertTable<Dim>::Place at{0, 0};
  std::uint64_t key = 0;
  for (int left = bits - step; left >= 0; left -= step) {
    at = hilbert_table<Dim>.of(at.state, x, left);
    key = key << unsigned{Dim * step} | at.place;
  }
  return key;
}

/// Number of bits in the key of a point.
template <int Dim>
inline constexpr unsigned hilbert_bits = Dim == 2 ? 48 : 60;
static_assert(hilbert_bits<2> / 2 % HilbertTable<2>::step == 0);
static_assert(hilbert_bits<3> / 3 % HilbertTable<3>::step == 0);

/// hilbert_key() of a point in the box. A point outside counts as the nearest point of the box, and
/// a coordinate that is not a number as the lowest: the checks sort the facets of broken meshes,
/// too.
template <int Dim>
std::uint64_t hilbert_key(const Vector<Dim>& point, const Box<Dim>& box) {
  constexpr int bits = hilbert_bits<Dim> / Dim;
  std::array<std::uint32_t, Dim> cell{};
  for (int i = 0; i < Dim; ++i) {
    const double width = std::max(box.high[i] - box.low[i], std::numeric_limits<double>::min());
    const double at = std::min(1., std::max(0., (point[i] - box.low[i]) / width));
    cell[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(at * ((1U << bits) - 1));
  }
  return hilbert_key_by_table<Dim>(cell, bits);
}

}  // namespace ductile::meshadapt
