/// @file
/// RunSort: a stable sort of keyed values that costs little when the input is a few sorted runs
/// one after the other, as it is when each thread walked its share of a list in order.
/// It finds the runs and merges neighbours until one is left (natural merge sort).
/// Thread safety: one thread at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace ductile::runtime {

template <class Key, class Value>
class RunSort {
 public:
  struct Keyed {
    Key key;
    Value value;
  };

  void clear() {
    items_.clear();
    run_begins_.clear();
  }

  void append(Key key, Value value) {
    if (items_.empty() || key < items_.back().key) run_begins_.push_back(items_.size());
    items_.push_back({key, value});
  }

  /// What was appended, ordered by key, equal keys as appended. Valid until the next append.
  std::span<const Keyed> sorted() {
    scratch_.resize(run_begins_.size() > 1 ? items_.size() : 0);
    while (run_begins_.size() > 1) merge_neighbours();
    return items_;
  }

 private:
  /// Halves the number of runs.
  void merge_neighbours() {
    const auto at = [](std::vector<Keyed>& v, std::size_t i) {
      return v.begin() + static_cast<std::ptrdiff_t>(i);
    };
    const auto less = [](const Keyed& a, const Keyed& b) { return a.key < b.key; };
    const std::size_t runs = run_begins_.size();
    const auto bound = [&](std::size_t r) { return r < runs ? run_begins_[r] : items_.size(); };
    std::size_t kept = 0;
    for (std::size_t r = 0; r < runs; r += 2) {
      const std::size_t begin = bound(r), middle = bound(r + 1), end = bound(r + 2);
      std::merge(at(items_, begin), at(items_, middle), at(items_, middle), at(items_, end),
                 at(scratch_, begin), less);
      run_begins_[kept++] = begin;
    }
    run_begins_.resize(kept);
    items_.swap(scratch_);
  }

  std::vector<Keyed> items_, scratch_;
  std::vector<std::size_t> run_begins_;  // where the sorted runs of items_ start
};

}  // namespace ductile::runtime
