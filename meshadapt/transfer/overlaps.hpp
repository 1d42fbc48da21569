/// @file
/// OverlapFinder<Dim>: visits the elements of one mesh that overlap an element of another, starting
/// from one that touches it and spreading across facets.
#pragma once

#include <cstdint>
#include <vector>

#include "transfer/clip.hpp"
#include "transfer/locator.hpp"

namespace ductile::meshadapt {

/// A set of ids that can be cleared at once.
class SeenSet {
 public:
  void clear() {
    count_ = 0;
    if (++round_ == 0) slots_.assign(slots_.size(), {}), round_ = 1;
  }

  /// Inserts an id; false if it was there.
  bool insert(ElementId id) {
    if (2 * ++count_ > slots_.size()) grow();
    return put(id);
  }

 private:
  struct Slot {
    ElementId id = 0;
    std::uint32_t round = 0;
  };

  bool put(ElementId id) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (id * std::size_t{2654435761U}) & mask;
    for (; slots_[at].round == round_; at = (at + 1) & mask)
      if (slots_[at].id == id) return false;
    slots_[at] = {id, round_};
    return true;
  }

  void grow() {
    std::vector<Slot> old(std::max<std::size_t>(64, 2 * slots_.size()));
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.round == round_) put(slot.id);
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
  std::uint32_t round_ = 1;
};

/// Serves one element after another; reuses its buffer.
template <int Dim>
class OverlapFinder {
 public:
  /// Calls visit(element, overlap) for every element of the old mesh that shares volume with
  /// `cell`, and returns the share of its volume that they cover. `centre` is the place of its
  /// centroid; `locator` is that of the old mesh.
  template <class Visit>
  double visit(const Locator<Dim>& locator, const Cell<Dim>& cell, const Place<Dim>& centre,
               Visit&& visit) {
    constexpr double all = 1 - 1e-9;
    seen_.clear();
    double covered = flood(locator.mesh(), cell, centre.element, visit);
    // If the domains differ, parts may be disconnected, so it also starts at the corners.
    for (std::size_t i = 0; i <= Dim && covered < all * cell.volume; ++i)
      covered +=
          flood(locator.mesh(), cell, locator.find(cell.corner[i], centre.element).element, visit);
    return covered / cell.volume;
  }

 private:
  template <class Visit>
  double flood(const FixedMesh<Dim>& mesh, const Cell<Dim>& cell, ElementId start, Visit&& visit) {
    double covered = 0;
    front_.clear();
    if (seen_.insert(start)) front_.push_back(start);
    while (!front_.empty()) {
      const ElementId element = front_.back();
      front_.pop_back();
      const Overlap<Dim> overlap =
          clipper_.overlap(cell, {mesh.points(element), mesh.volume_of[element]});
      if (!(overlap.volume > 0)) continue;
      covered += overlap.volume;
      visit(element, overlap);
      for (const ElementId next : mesh.neighbour_of[element])
        if (next != none && seen_.insert(next)) front_.push_back(next);
    }
    return covered;
  }

  Clipper<Dim> clipper_;
  SeenSet seen_;
  std::vector<ElementId> front_;
};

}  // namespace ductile::meshadapt
