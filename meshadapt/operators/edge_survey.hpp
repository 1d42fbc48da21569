/// @file
/// EdgeSurvey: which edges of an element may be too short or too long, kept from scan to scan until
/// the element changes, so that scans for one and for the other measure it once. Elements are
/// measured eight side by side.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "core/lanes.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
class EdgeSurvey {
 public:
  /// Edges not below the one, and not above the other, are certain to be neither. Measured with a
  /// margin, as compilers may round the same formula in different ways in different places.
  struct Limits {
    double shorter, longer;
    friend bool operator==(const Limits&, const Limits&) = default;
  };
  /// Elements in a row that are looked through together.
  static constexpr std::size_t stretch = 64;

  explicit EdgeSurvey(const Limits& limits = {}) : limits_(limits) {}

  /// Forgets what is known if this is not what it was measured by.
  void compare_with(const Limits& limits) {
    if (limits != limits_) forget();
    limits_ = limits;
  }
  /// To be called where elements have got other numbers, or vertices have moved.
  void forget() {
    bits_.clear();
    seen_ = 0;
  }

  /// Measures the wanted ones of what is not known or has changed. All that has changed since this
  /// was last called is wanted.
  /// Thread safety: one caller; runs on the executor.
  void renew(const runtime::Executor& executor, const Mesh<Dim>& mesh, auto&& wanted) {
    runtime::grow_filled(executor, bits_, mesh.element_slots(), 0);
    const auto measure_wanted = [&](std::size_t, std::size_t begin, std::size_t end) {
      const auto unknown = [&](std::size_t e) {
        return static_cast<int>(bits_[e] == 0) | static_cast<int>(mesh.changed_at[e] > seen_);
      };
      List list;
      if (!select(begin, end, unknown, list)) return;
      std::size_t left = 0;
      for (std::size_t i = 0; i < list.size; ++i) {
        list.element[left] = list.element[i];
        left += mesh.alive(list.element[i]) && wanted(list.element[i]);
      }
      list.size = left;
      measure(mesh, list);
    };
    runtime::parallel_for_blocks(executor, mesh.element_slots(), stretch, measure_wanted, {});
    seen_ = mesh.epoch - 1;
  }

  /// Call visit(element, edge) for edges of a stretch of elements that may be shorter than the one
  /// limit, or longer than the other; of elements that were not wanted of late, as they once were.
  void visit_shorter(const Mesh<Dim>& mesh, std::size_t begin, auto&& visit) const {
    visit_bits(mesh, begin, 0, visit);
  }
  void visit_longer(const Mesh<Dim>& mesh, std::size_t begin, auto&& visit) const {
    visit_bits(mesh, begin, edges, visit);
  }

 private:
  static constexpr std::size_t edges = Simplex<Dim>::edges;
  /// Of the edges of an element: those that may be shorter, then those that may be longer, and one
  /// more; 0 where nothing is known.
  using Bits = std::conditional_t<Dim == 2, std::uint8_t, std::uint16_t>;
  static constexpr Bits all = (1U << edges) - 1, known = 1U << (2 * edges);

  using SiteOfLane = std::array<const Site<Dim>*, lane_count>;
  /// Elements of a stretch, and room to fill up lanes.
  struct List {
    std::array<ElementId, stretch + lane_count> element;
    std::size_t size = 0;
  };

  /// Lists elements, without branches, as chance decides which; false if there are none.
  static bool select(std::size_t begin, std::size_t end, auto&& wanted, List& list) {
    std::size_t any = 0;
    for (std::size_t e = begin; e < end; ++e) any += wanted(e);
    if (any == 0) return false;
    for (std::size_t e = begin; e < end; ++e) {
      list.element[list.size] = static_cast<ElementId>(e);
      list.size += wanted(e);
    }
    return true;
  }

  void visit_bits(const Mesh<Dim>& mesh, std::size_t begin, std::size_t shift, auto&& visit) const {
    const std::size_t end = std::min(mesh.element_slots(), begin + stretch);
    const auto mask = static_cast<Bits>(all << shift);
    List list;
    select(
        begin, end, [&](std::size_t e) { return static_cast<int>((bits_[e] & mask) != 0); }, list);
    for (std::size_t i = 0; i < list.size; ++i) {
      const ElementId e = list.element[i];
      if (!mesh.alive(e)) continue;
      for (unsigned left = (bits_[e] & mask) >> shift; left != 0; left &= left - 1)
        visit(e, static_cast<std::size_t>(std::countr_zero(left)));
    }
  }

  /// Looks up sites ahead, so that lanes do not wait for each other.
  void measure(const Mesh<Dim>& mesh, List& list) {
    std::array<std::array<const Site<Dim>*, Dim + 1>, stretch + lane_count> sites;
    for (std::size_t i = 0; i < list.size; ++i) {
      const Corners<Dim>& corners = mesh.corners_of[list.element[i]];
      for (std::size_t c = 0; c <= Dim; ++c) {
        sites[i][c] = &mesh.site_of[corners[c]];
        __builtin_prefetch(sites[i][c]);
      }
    }
    for (std::size_t i = list.size; i % lane_count != 0; ++i) sites[i] = sites[i - 1];
    for (std::size_t i = 0; i < list.size; i += lane_count) {
      const auto bits = measured(std::span(sites).subspan(i).template first<lane_count>());
      for (std::size_t l = 0; l < lane_count && i + l < list.size; ++l)
        bits_[list.element[i + l]] = static_cast<Bits>(bits[l] | known);
    }
  }

  [[gnu::noinline]] LanesIn<std::uint64_t> measured(
      std::span<const std::array<const Site<Dim>*, Dim + 1>, lane_count> sites) const {
    std::array<LanesOf<Dim>, Dim + 1> position;
    std::array<LanesOf<Metric<Dim>::size>, Dim + 1> metric;
    for (std::size_t c = 0; c <= Dim; ++c) {
      SiteOfLane site;
      for (std::size_t l = 0; l < lane_count; ++l) site[l] = sites[l][c];
      read(site, position[c], metric[c]);
    }
    LanesIn<std::uint64_t> bits{};
    const auto compare_all = [&]<std::size_t... edge>(std::index_sequence<edge...>) {
      (compare<edge>(position, metric, bits), ...);
    };
    compare_all(std::make_index_sequence<edges>());
    return bits;
  }

  /// Sets the bits of one edge. Which edge it is must be known to the compiler: only then are lanes
  /// compared side by side.
  template <std::size_t edge>
  [[gnu::always_inline]] void compare(const std::array<LanesOf<Dim>, Dim + 1>& position,
                                      const std::array<LanesOf<Metric<Dim>::size>, Dim + 1>& metric,
                                      LanesIn<std::uint64_t>& bits) const {
    constexpr auto a = static_cast<std::size_t>(Simplex<Dim>::edge[edge][0]);
    constexpr auto b = static_cast<std::size_t>(Simplex<Dim>::edge[edge][1]);
    constexpr std::uint64_t short_bit = std::uint64_t{1} << edge, long_bit = short_bit << edges;
    constexpr double margin = 1e-12;
    const double below = limits_.shorter * limits_.shorter, above = limits_.longer * limits_.longer;
    const double shorter = (1 + margin) * (below * below), longer = (1 - margin) * above;
    for (std::size_t l = 0; l < lane_count; ++l) {
      Vector<Dim> along;
      for (std::size_t i = 0; i < Dim; ++i) along.x[i] = position[b][i][l] - position[a][i][l];
      const double at_a = squared_length(tensor_at<Dim>(metric[a], l), along);
      const double at_b = squared_length(tensor_at<Dim>(metric[b], l), along);
      const double greater = at_a > at_b ? at_a : at_b;
      bits[l] |= (at_a * at_b < shorter ? short_bit : 0) | (greater < longer ? 0 : long_bit);
    }
  }

  [[gnu::always_inline]] static void read(const SiteOfLane& site, LanesOf<Dim>& position,
                                          LanesOf<Metric<Dim>::size>& metric) {
    static_assert(sizeof(Site<Dim>) == (Dim + Metric<Dim>::size + 1) * sizeof(double));
    if constexpr (Dim == 2) {
      transpose(site, 0, {&position[0], &position[1], &metric[0], &metric[1]});
      transpose(site, 2, {nullptr, nullptr, &metric[2], nullptr});
    } else {
      transpose(site, 0, {&position[0], &position[1], &position[2], &metric[0]});
      transpose(site, 4, {&metric[1], &metric[2], &metric[3], &metric[4]});
      transpose(site, 6, {nullptr, nullptr, &metric[5], nullptr});
    }
  }

  runtime::UnsetVector<Bits> bits_;  // [element], of no use where it is gone
  Limits limits_;
  std::uint32_t seen_ = 0;  // what changed later is not known
};

}  // namespace ductile::meshadapt
