/// @file
/// ListedTwice: facets or edges that are listed more than once, as programs do that write each from
/// both sides. The first one stands for all of them, and one warning tells of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/first_bad.hpp"

namespace ductile::meshadapt {

class ListedTwice {
 public:
  /// "edge" or "triangle", and [entity] the references of those that are listed.
  ListedTwice(const char* kind, const std::vector<std::int32_t>& reference_of)
      : kind_(kind), reference_of_(reference_of) {}

  /// `again` has the corners of `first`, which comes before it.
  void add(std::size_t first, std::size_t again) {
    if (count_++ == 0) example_ = {first, again};
    if (reference_of_[first] == reference_of_[again]) return;
    if (different_++ == 0) differing_ = {first, again};
  }

  bool empty() const { return count_ == 0; }

  /// What was merged and, where references differ, which was kept.
  std::string warning() const {
    const std::string plural = std::string(kind_) + "s";
    std::string text = std::to_string(count_) + " of " + std::to_string(reference_of_.size()) +
                       " listed " + plural + " were listed before and are merged; the first, " +
                       entity(kind_, example_.again) + ", is the same as " +
                       entity(kind_, example_.first);
    if (different_ == 0) return text;
    return text + "; where references differ (" + std::to_string(different_) +
           " of them), that of the one listed first is kept: " + with_reference(differing_.first) +
           ", not " + with_reference(differing_.again);
  }

 private:
  struct Pair {
    std::size_t first = 0, again = 0;
  };

  std::string with_reference(std::size_t index) const {
    return std::to_string(reference_of_[index]) + " of " + entity(kind_, index);
  }

  const char* kind_;
  const std::vector<std::int32_t>& reference_of_;
  std::size_t count_ = 0, different_ = 0;
  Pair example_, differing_;
};

}  // namespace ductile::meshadapt
