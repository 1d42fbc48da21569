/// @file
/// Refine's last stage: new vertices and elements take numbers by prefix sums, and each element is
/// cut on its own. What is written here is decided before, in refine.cpp.
#include <functional>
#include <stdexcept>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "operators/refine.hpp"

namespace ductile::meshadapt {

using runtime::few_nanoseconds;
using runtime::make_filled;
using runtime::parallel_for;
using runtime::PhaseTimer;
using runtime::with;

/// With more edges to split than this share of the number of elements, lists are left stale.
constexpr double many = 0.05;

template <int Dim, int Space>
void Refine<Dim, Space>::number() {
  place_of_ = make_filled<std::uint32_t>(executor_, edges_.size());
  first_piece_ = make_filled<std::uint32_t>(executor_, elements_.size());
  parallel_for(
      executor_, edges_.size(),
      [&](std::size_t i) { place_of_[i] = is_split(static_cast<std::uint32_t>(i)); },
      few_nanoseconds);
  parallel_for(
      executor_, elements_.size(), [&](std::size_t i) { first_piece_[i] = cuts_[i].pieces - 1; },
      few_nanoseconds);
  first_vertex_ = static_cast<VertexId>(mesh_.vertex_slots());
  first_element_ = static_cast<ElementId>(mesh_.element_slots());
  report_.applied = runtime::exclusive_scan<std::uint32_t>(executor_, place_of_);
  expect_countable();
  end_of_elements_ =
      first_element_ + runtime::exclusive_scan<std::uint32_t>(executor_, first_piece_);
}

/// Throws if there are not numbers for all new elements, which first_piece_ still counts one by
/// one.
template <int Dim, int Space>
void Refine<Dim, Space>::expect_countable() const {
  constexpr std::size_t most_pieces = 7;  // beside the first
  std::size_t end = std::size_t{first_element_} + most_pieces * elements_.size();
  if (end < none) return;
  const auto pieces_of = [&](std::size_t i) { return std::size_t{first_piece_[i]}; };
  end = first_element_ + runtime::parallel_reduce(executor_, elements_.size(), std::size_t{0},
                                                  pieces_of, std::plus<>());
  if (end >= none) throw std::length_error("a mesh of more elements than 32-bit numbers can count");
}

/// Makes what is numbered, and brings the lists of vertices up to date change by change, unless
/// there is so much of it that to make all lists anew takes less.
template <int Dim, int Space>
void Refine<Dim, Space>::grow() {
  lists_are_stale_ = !defers_all_lists_ && static_cast<double>(report_.applied) >
                                               many * static_cast<double>(first_element_);
  DeferredLists deferred(executor_);
  const auto defer_to = [&](const auto& mine) {
    return [&](VertexId owner, const ListChange& change) {
      if (!lists_are_stale_ || change.curve != 0) mine.defer(owner, change);
    };
  };
  {
    const PhaseTimer timer(report_.apply_seconds);
    const std::size_t end_of_vertices = first_vertex_ + report_.applied;
    mesh_.grow(executor_, end_of_vertices, first_element_);
    const auto write = [&](std::size_t i, [[maybe_unused]] const auto& mine) {
      const auto number = static_cast<std::uint32_t>(i);
      if (!is_split(number)) return;
      write_vertex(number);
      if constexpr (Dim == 3) write_links(number, defer_to(mine));
    };
    parallel_for(executor_, edges_.size(), with(deferred), write, {.serial_below = 64});
    splits_.release(executor_);  // before elements take their memory
    mesh_.grow(executor_, end_of_vertices, end_of_elements_);
    parallel_for(executor_, elements_.size(), with(deferred),
                 [&](std::size_t i, const auto& mine) { write_pieces(i, defer_to(mine)); });
  }
  const PhaseTimer timer(report_.commit_seconds);
  report_.committed = commit_lists(mesh_, deferred);
}

template <int Dim, int Space>
void Refine<Dim, Space>::write_vertex(std::uint32_t number) {
  const Split& split = splits_[number];
  const VertexId v = vertex_of(number);
  mesh_.site_of[v] = split.site;
  mesh_.kind_of[v] = split.kind;
  mesh_.entity_of[v] = split.entity;
  mesh_.reference_of[v] = split.reference;
  mesh_.host_of[v] = split.host;
}

/// The parts of a curve that is split: each end is linked to the middle, and no longer to the other
/// end.
template <int Dim, int Space>
void Refine<Dim, Space>::write_links(std::uint32_t number, auto&& defer) {
  const Split& split = splits_[number];
  if (split.kind.class_dimension != 1) return;
  using Kind = ListChange::Kind;
  const LongEdge& edge = edges_[number];
  const VertexId middle = vertex_of(number);
  for (const auto& [end, other] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
    defer(end, {Kind::remove_link, other, split.entity});
    defer(end, {Kind::add_link, middle, split.entity});
    mesh_.links_of.insert(middle, {end, split.entity});
  }
}

/// The first piece keeps the element's number.
template <int Dim, int Space>
void Refine<Dim, Space>::write_pieces(std::size_t place, auto&& defer) {
  const ElementId element = elements_[place];
  const Cuts& cuts = cuts_[place];
  if (cuts.pieces == 1) return;
  const Order order = order_of(cuts);
  Pieces<Dim> pieces;
  for (std::size_t i = 0; i < order.size; ++i) pieces.cut(order.edge[i]);
  std::array<VertexId, points_of_cut<Dim>> vertices;
  for (std::size_t i = 0; i <= Dim; ++i) vertices[i] = mesh_.corners_of[element][i];
  for (std::size_t i = 0; i < order.size; ++i)
    vertices[middle_of<Dim>(order.edge[i])] = vertex_of(cuts.split[order.edge[i]] - 1);

  const Corners<Dim> before = mesh_.corners_of[element];
  const auto patches = mesh_.patches_of[element];
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Piece<Dim>& piece = pieces[p];
    const ElementId to =
        p == 0 ? element : first_element_ + first_piece_[place] + static_cast<std::uint32_t>(p) - 1;
    for (std::size_t c = 0; c <= Dim; ++c) {
      const VertexId v = vertices[piece.corners[c]];
      const std::uint8_t facet = piece.facet_of[c];
      mesh_.corners_of[to][c] = v;
      mesh_.patches_of[to][c] = facet == Piece<Dim>::inside ? 0 : patches[facet];
      if (p != 0 || v != before[c]) defer(v, {ListChange::Kind::add_element, to});
      if (p == 0 && v != before[c]) defer(before[c], {ListChange::Kind::remove_element, element});
    }
    mesh_.region_of[to] = mesh_.region_of[element];
    mesh_.quality_of[to] = cuts.quality[p];
    mesh_.changed_at[to] = mesh_.epoch;
  }
}

template void Refine<2>::number();
template void Refine<2, 3>::number();
template void Refine<3>::number();
template void Refine<2>::grow();
template void Refine<2, 3>::grow();
template void Refine<3>::grow();

}  // namespace ductile::meshadapt
