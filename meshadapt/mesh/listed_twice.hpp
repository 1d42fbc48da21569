/// @file
/// ListedTwice: facets or edges that are listed more than once, as by programs that write each from
/// both sides. The first one is kept, with one warning for all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/first_bad.hpp"

namespace ductile::meshadapt {

class ListedTwice {
 public:
  /// The kind is "edge" or "triangle"; [entity] are the references of the listed ones.
  ListedTwice(const char* kind, const std::vector<std::int32_t>& reference_of)
      : kind_(kind), reference_of_(reference_of) {}

  /// Notes that `again` has the corners of `first`, which precedes it.
  void add(std::size_t first, std::size_t again) {
    if (count_++ == 0) example_ = {first, again};
    if (reference_of_[first] == reference_of_[again]) return;
    if (different_++ == 0) differing_ = {first, again};
  }

  bool empty() const { return count_ == 0; }

  /// A warning that says what was merged and, if references differ, which was kept.
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
