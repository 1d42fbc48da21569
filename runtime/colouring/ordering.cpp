#include "ductile/runtime/colouring/ordering.hpp"

namespace ductile::runtime::detail {

std::vector<std::uint32_t> counting_sort(std::span<const std::uint32_t> key_of, std::size_t keys) {
  std::vector<std::uint32_t> next(keys + 1), sorted(key_of.size());
  for (const std::uint32_t key : key_of) ++next[key + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::uint32_t v = 0; v < key_of.size(); ++v) sorted[next[key_of[v]]++] = v;
  return sorted;
}

DegreeBuckets::DegreeBuckets(std::vector<std::uint32_t> degree_of)
    : degree_of_(std::move(degree_of)), place_of_(degree_of_.size()) {
  const std::uint32_t most =
      degree_of_.empty() ? 0 : *std::max_element(degree_of_.begin(), degree_of_.end());
  vertices_ = counting_sort(degree_of_, std::size_t{most} + 1);
  begin_of_.resize(std::size_t{most} + 2);
  for (const std::uint32_t degree : degree_of_) ++begin_of_[degree + 1];
  std::partial_sum(begin_of_.begin(), begin_of_.end(), begin_of_.begin());
  for (std::uint32_t i = 0; i < vertices_.size(); ++i) place_of_[vertices_[i]] = i;
}

std::uint32_t DegreeBuckets::remove(std::size_t i) {
  removed_ = i + 1;
  return vertices_[i];
}

void DegreeBuckets::lower(std::uint32_t u) {
  const std::uint32_t degree = degree_of_[u];
  if (place_of_[u] < removed_ || degree == 0) return;
  // A bucket that begins before removed_ has lost its first vertices to remove(). Exchanges u and
  // the first vertex of its bucket, which becomes the last of the bucket below.
  const std::uint32_t first = std::max(begin_of_[degree], static_cast<std::uint32_t>(removed_));
  const std::uint32_t other = vertices_[first];
  std::swap(vertices_[place_of_[u]], vertices_[first]);
  std::swap(place_of_[u], place_of_[other]);
  begin_of_[degree] = first + 1;
  --degree_of_[u];
}

}  // namespace ductile::runtime::detail
