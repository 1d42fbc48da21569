/// @file
/// ElementFields<Dim>: transfers fields that are constant in each element to another mesh.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "transfer/coverage.hpp"
#include "transfer/evaluate.hpp"
#include "transfer/overlaps.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class ElementFields {
 public:
  /// Refers to all arguments. `field` has values [old element * stride + component].
  ElementFields(const runtime::Executor& executor, const Locator<Dim, Space>& from,
                const Components& field, const FixedMesh<Dim, Space>& to)
      : executor_(executor), from_(from), field_(field), to_(to) {}

  /// Values at the centroids of the new elements: [new element * stride + component].
  std::vector<double> at_centroids() const {
    std::vector<double> result(to_.element_count() * field_.stride);
    each_element([&](std::size_t e, const Place<Dim>& centre) {
      std::copy_n(old_values(centre.element), field_.stride, &result[e * field_.stride]);
    });
    return result;
  }

  /// The same with means over new elements. Fills in how well the meshes cover each other.
  std::vector<double> means(Coverage& coverage) const {
    std::vector<double> result(to_.element_count() * field_.stride);
    std::vector<double> covered(to_.element_count());
    runtime::PerThread<Summing> summing(executor_);
    each_element([&](std::size_t e, const Place<Dim>& centre) {
      covered[e] = mean(e, centre, summing.mine(), &result[e * field_.stride]);
    });
    coverage = meshadapt::coverage(executor_, from_.mesh(), to_, covered);
    return result;
  }

 private:
  /// Scratch data of a thread.
  struct Summing {
    OverlapFinder<Dim> finder;
    std::vector<double> low, high;  // [component]
  };

  void each_element(auto&& visit) const {
    walk_in_blocks(executor_, to_.element_count(), [&](std::size_t e, ElementId near) {
      const Place<Dim> centre =
          from_.find(centroid_of(to_, static_cast<ElementId>(e)), Dim < Space ? none : near);
      visit(e, centre);
      return centre.element;
    });
  }

  const double* old_values(ElementId element) const {
    return &field_.values[element * field_.stride];
  }

  /// Sets result[component] to the mean over an element and returns the covered share.
  double mean(std::size_t element, const Place<Dim>& centre, Summing& summing,
              double* result) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    summing.low.assign(field_.stride, infinity);
    summing.high.assign(field_.stride, -infinity);
    const double volume = to_.volume_of[element];
    const auto add = [&](ElementId other, double part) {
      for (std::size_t k = 0; k < field_.stride; ++k) {
        const double value = old_values(other)[k];
        result[k] += part / volume * value;
        summing.low[k] = std::min(summing.low[k], value);
        summing.high[k] = std::max(summing.high[k], value);
      }
    };
    const Cell<Dim> cell{to_.points(static_cast<ElementId>(element)), volume};
    const double covered = summing.finder.visit(
        from_, cell, centre,
        [&](ElementId other, const Overlap<Dim>& overlap) { add(other, overlap.volume); });
    if (covered < 1 - least_share) add(centre.element, (1 - covered) * volume);
    for (std::size_t k = 0; k < field_.stride; ++k)  // removes rounding errors
      result[k] = std::clamp(result[k], summing.low[k], summing.high[k]);
    return covered;
  }

  const runtime::Executor& executor_;
  const Locator<Dim, Space>& from_;
  Components field_;
  const FixedMesh<Dim, Space>& to_;
};

}  // namespace ductile::meshadapt
