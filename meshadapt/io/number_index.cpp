#include "number_index.hpp"

#include <algorithm>

namespace ductile::meshadapt {

NumberIndex::NumberIndex(const std::vector<std::uint64_t>& numbers) {
  if (numbers.empty()) return;
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  first_ = *least;
  const std::uint64_t range = *most - *least;
  is_dense_ = range < 4 * numbers.size() + 64;
  if (is_dense_) {
    place_of_.assign(static_cast<std::size_t>(range) + 1, none);
    for (std::size_t place = 0; place < numbers.size(); ++place) {
      std::size_t& entry = place_of_[static_cast<std::size_t>(numbers[place] - first_)];
      if (entry != none) repeated_ = place;
      entry = place;
    }
    return;
  }
  sorted_.reserve(numbers.size());
  for (std::size_t place = 0; place < numbers.size(); ++place)
    sorted_.emplace_back(numbers[place], place);
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i].first == sorted_[i - 1].first) repeated_ = sorted_[i].second;
}

std::size_t NumberIndex::find(std::uint64_t number) const {
  if (is_dense_)
    return number < first_ || number - first_ >= place_of_.size()
               ? none
               : place_of_[static_cast<std::size_t>(number - first_)];
  const auto found = std::lower_bound(
      sorted_.begin(), sorted_.end(), number,
      [](const auto& entry, std::uint64_t wanted) { return entry.first < wanted; });
  return found == sorted_.end() || found->first != number ? none : found->second;
}

}  // namespace ductile::meshadapt
