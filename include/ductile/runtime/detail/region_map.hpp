/// @file
/// RegionMap: the region of each resource. A grid of cells covers all resources; a Hilbert curve
/// through the cells is cut into regions with equal numbers of resources. The grid is shifted along
/// the curve before each cut, so that the borders of regions move.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/numbers.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

struct RegionCut {
  std::size_t count;   ///< number of regions
  std::uint64_t turn;  ///< determines how the grid is shifted
  std::size_t
      changed;        ///< items applied since the last cut: resources lie elsewhere, or are others
  bool anew = false;  ///< recompute the cells of all resources
};

/// Dim is the dimension of the places, 1 to 3.
template <std::size_t Dim>
class RegionMap {
 public:
  using Region = std::uint16_t;
  using Place = std::array<double, Dim>;

  /// Cuts all resources into regions. set_owner() may change owners until the next cut.
  void cut(const Executor& executor, const Numbers& resources, auto&& place_of,
           const RegionCut& cut) {
    make_room(resources.top());
    find_blocks(resources);
    changed_ += cut.changed;
    label(executor, resources.used(), place_of, cut.anew);
    cut_curve(executor, cut.count, cut.turn);
    for_each_in_use(executor, [&](std::size_t r) { owner_of_[r] = region_of_cell_[cell_of_[r]]; });
  }

  /// Makes room for resources added since the cut, with numbers below `end`.
  void make_room(std::size_t end) {
    const std::size_t begin = cell_of_.size();
    if (begin >= end) return;
    cell_of_.resize(end);
    owner_of_.resize(end);
    std::fill(cell_of_.begin() + static_cast<std::ptrdiff_t>(begin), cell_of_.end(), unlabelled);
  }

  Region owner_of(std::uint32_t resource) const { return owner_of_[resource]; }
  void set_owner(std::uint32_t resource, Region region) { owner_of_[resource] = region; }

 private:
  using Cell = std::uint16_t;
  static constexpr Cell unlabelled = 0xffff;
  static constexpr int most_bits = Dim == 3 ? 5 : 14 / static_cast<int>(Dim);  // of a cell per axis
  static constexpr std::size_t resources_a_cell = 32, block_size = 4096;

  void find_blocks(const Numbers& resources) {
    blocks_.clear();
    resources.for_each_used([&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t at = begin; at < end; at += std::min<std::uint32_t>(block_size, end - at))
        blocks_.push_back({at, at + std::min<std::uint32_t>(block_size, end - at)});
    });
  }

  void for_each_in_use(const Executor& executor, auto&& visit) {
    parallel_for(executor, blocks_.size(),
                 [&](std::size_t b) {
                   for (std::uint32_t r = blocks_[b].begin; r < blocks_[b].end; ++r) visit(r);
                 },
                 {.grain = 1});
  }

  /// A new thing takes the cell of its own place, because inherited cells would become ragged. All
  /// cells are recomputed after many changes.
  void label(const Executor& executor, std::size_t used, auto&& place_of, bool anew) {
    const bool first = labelled_ == 0 || used > 4 * labelled_;
    const bool all = first || anew || changed_ > used / 16;
    if (first) {
      labelled_ = used;
      constexpr int dim = static_cast<int>(Dim);
      bits_ =
          std::clamp(static_cast<int>(std::bit_width(used / resources_a_cell)) / dim, 2, most_bits);
      find_extent(executor, place_of);
    }
    if (all) changed_ = 0;
    for_each_in_use(executor, [&](std::size_t r) {
      if (all || cell_of_[r] == unlabelled)
        cell_of_[r] = cell_at(place_of(static_cast<std::uint32_t>(r)));
    });
  }

  void find_extent(const Executor& executor, auto&& place_of) {
    constexpr double most = std::numeric_limits<double>::max();
    struct Extent {
      Place low, high;
    };
    Extent none;
    none.low.fill(most);
    none.high.fill(-most);
    const auto join = [](const Extent& a, const Extent& b) {
      Extent both = a;
      for (std::size_t i = 0; i < Dim; ++i) {
        both.low[i] = std::min(both.low[i], b.low[i]);
        both.high[i] = std::max(both.high[i], b.high[i]);
      }
      return both;
    };
    const Extent extent = parallel_reduce(
        executor, blocks_.size(), none,
        [&](std::size_t b) {
          Extent own = none;
          for (std::uint32_t r = blocks_[b].begin; r < blocks_[b].end; ++r) {
            const Place place = place_of(r);
            own = join(own, {place, place});
          }
          return own;
        },
        join);
    low_ = extent.low;
    double width = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < Dim; ++i) width = std::max(width, extent.high[i] - extent.low[i]);
    scale_ = static_cast<double>(1U << bits_) / width;
  }

  /// The first coordinate is in the lowest bits. Places outside the extent belong to the nearest
  /// cell.
  Cell cell_at(const Place& place) const {
    const double last = static_cast<double>((1U << bits_) - 1);
    std::uint32_t cell = 0;
    for (std::size_t i = Dim; i-- > 0;)
      cell = cell << bits_ |
             static_cast<std::uint32_t>(std::clamp((place[i] - low_[i]) * scale_, 0.0, last));
    return static_cast<Cell>(cell);
  }

  /// Number of resources per cell, estimated from every eighth.
  std::vector<std::uint32_t> count_held() const {
    constexpr std::size_t step = 8;
    std::vector<std::uint32_t> held(std::size_t{1} << (static_cast<int>(Dim) * bits_));
    std::size_t skip = 0;
    for (const NumberRange block : blocks_) {
      std::size_t r = block.begin + skip;
      for (; r < block.end; r += step) held[cell_of_[r]] += step;
      skip = r - block.end;
    }
    return held;
  }

  void cut_curve(const Executor& executor, std::size_t count, std::uint64_t turn) {
    const std::vector<std::uint32_t> held = count_held();
    const std::uint32_t side = 1U << bits_;
    const std::uint64_t shift = mix64(turn);
    constexpr std::uint32_t nowhere = 0xffffffffU;
    std::vector<std::uint32_t> cell_at_place(held.size() << Dim, nowhere);
    parallel_for(executor, held.size(), [&](std::size_t cell) {
      std::array<std::uint32_t, Dim> x;
      for (std::size_t i = 0; i < Dim; ++i)
        x[i] =
            static_cast<std::uint32_t>(cell >> (i * static_cast<std::size_t>(bits_)) & (side - 1)) +
            static_cast<std::uint32_t>((shift >> (16 * i) & 0xffffU) * side >> 16U);
      cell_at_place[hilbert_key<Dim>(x, bits_ + 1)] = static_cast<std::uint32_t>(cell);
    });
    const std::size_t total = std::accumulate(held.begin(), held.end(), held.size());
    region_of_cell_.resize(held.size());
    std::size_t before = 0;
    for (const std::uint32_t cell : cell_at_place) {
      if (cell == nowhere) continue;
      region_of_cell_[cell] = static_cast<Region>(before * count / total);
      before += held[cell] + 1;
    }
  }

  std::vector<NumberRange> blocks_;  // of resources in use
  std::size_t labelled_ = 0;         // number of resources when the grid was made
  std::size_t changed_ = 0;          // number of items applied since all were labelled
  int bits_ = 2;
  Place low_{};
  double scale_ = 1;                    // cells per unit of length
  UnsetVector<Cell> cell_of_;           // [resource]
  UnsetVector<Region> owner_of_;        // [resource]
  UnsetVector<Region> region_of_cell_;  // [cell]
};

}  // namespace ductile::runtime::detail
