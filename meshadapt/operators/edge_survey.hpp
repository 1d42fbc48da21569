/// @file
/// EdgeSurvey: which edges of an element may be too short or too long, kept from scan to scan until
/// the element changes, so that scans for one and for the other measure it once. Elements are
/// measured eight side by side.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "core/lanes.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class EdgeSurvey {
 public:
  /// Edges between the limits are certain to be neither short nor long. There is a margin, because
  /// compilers may round the same formula differently in different places.
  struct Limits {
    double shorter, longer;
    friend bool operator==(const Limits&, const Limits&) = default;
  };
  /// Elements in a row that are looked through together.
  static constexpr std::size_t stretch = 64;

  explicit EdgeSurvey(const Limits& limits = {}) : limits_(limits) {}

  /// Sets the limits; forgets all measurements if they were others.
  void compare_with(const Limits& limits) {
    if (limits != limits_) forget();
    limits_ = limits;
  }
  /// Forgets all measurements; to be called after elements are renumbered or vertices move.
  void forget() {
    bits_.clear();
    seen_ = 0;
  }

  /// Measures wanted elements whose lengths are unknown or stale. All that have changed since the
  /// last call must be wanted.
  /// Thread safety: one caller; runs on the executor.
  void renew(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh, auto&& wanted) {
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
  /// limit, or longer than the other. Elements that renew() did not want lately are judged by their
  /// last measurement.
  void visit_shorter(const Mesh<Dim, Space>& mesh, std::size_t begin, auto&& visit) const {
    visit_bits(mesh, begin, 0, visit);
  }
  void visit_longer(const Mesh<Dim, Space>& mesh, std::size_t begin, auto&& visit) const {
    visit_bits(mesh, begin, edges, visit);
  }

 private:
  static constexpr std::size_t edges = Simplex<Dim>::edges;
  /// One bit for each edge that may be shorter, then one for each that may be longer, then `known`;
  /// 0 where nothing is known.
  using Bits = std::conditional_t<Dim == 2, std::uint8_t, std::uint16_t>;
  static constexpr Bits all = (1U << edges) - 1, known = 1U << (2 * edges);

  /// Elements of a stretch, and room to fill up lanes.
  struct List {
    std::array<ElementId, stretch + lane_count> element;
    std::size_t size = 0;
  };

  /// Lists the wanted elements, without branches because those would be mispredicted; false if
  /// there are none.
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

  void visit_bits(const Mesh<Dim, Space>& mesh, std::size_t begin, std::size_t shift,
                  auto&& visit) const {
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

  void measure(const Mesh<Dim, Space>& mesh, List& list);

  runtime::UnsetVector<Bits> bits_;  // [element], of no use where it is gone
  Limits limits_;
  std::uint32_t seen_ = 0;  // what changed later is not known
};

extern template class EdgeSurvey<2>;
extern template class EdgeSurvey<2, 3>;
extern template class EdgeSurvey<3>;

}  // namespace ductile::meshadapt
