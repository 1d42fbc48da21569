#include "ductile/runtime/colouring/balance.hpp"

#include <algorithm>
#include <utility>

namespace ductile::runtime::detail {

ClassSizes::ClassSizes(const ColourClasses& classes)
    : fair_(classes.vertices.empty() ? 0 : (classes.vertices.size() - 1) / classes.count() + 1) {
  for (std::size_t c = 0; c < classes.count(); ++c) size_of_.push_back(classes.members(c).size());
  find_room();
}

std::size_t ClassSizes::surplus(std::uint32_t colour) const {
  return size_of_[colour] > fair_ ? size_of_[colour] - fair_ : 0;
}

std::size_t ClassSizes::room(std::uint32_t colour) const {
  return size_of_[colour] < fair_ ? fair_ - size_of_[colour] : 0;
}

void ClassSizes::find_room() {
  room_before_.assign(1, 0);
  for (std::uint32_t c = 0; c < size_of_.size(); ++c)
    room_before_.push_back(room_before_.back() + room(c));
}

std::uint32_t ClassSizes::colour_with_room(std::uint32_t number) const {
  const std::size_t place = number % room();
  const auto after = std::upper_bound(room_before_.begin(), room_before_.end(), place);
  return static_cast<std::uint32_t>(after - room_before_.begin() - 1);
}

std::size_t ClassSizes::move(const Executor& executor, std::span<const std::uint32_t> vertices,
                             std::span<const std::uint32_t> wanted,
                             std::vector<std::uint32_t>& colour_of) {
  const std::size_t colours = size_of_.size(), n = vertices.size();
  const std::uint32_t from = colour_of[vertices.front()];
  const std::size_t block = std::max<std::size_t>({2048, 4 * colours, n / 256});
  const std::size_t blocks = (n + block - 1) / block;
  // [block][colour], last column: all. First counts, then how many earlier vertices want the
  // colour.
  std::vector<std::size_t> before(blocks * (colours + 1));
  parallel_for_blocks(executor, n, block, [&](std::size_t b, std::size_t begin, std::size_t end) {
    std::size_t* const row = &before[b * (colours + 1)];
    for (std::size_t i = begin; i < end; ++i)
      if (wanted[i] != Colouring::none) ++row[wanted[i]], ++row[colours];
  });
  std::vector<std::size_t> total(colours + 1);
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t c = 0; c <= colours; ++c)
      total[c] += std::exchange(before[b * (colours + 1) + c], total[c]);
  std::vector<std::size_t> went(blocks * colours);
  parallel_for_blocks(executor, n, block, [&](std::size_t b, std::size_t begin, std::size_t end) {
    std::size_t* const row = &before[b * (colours + 1)];
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t to = wanted[i];
      if (to == Colouring::none) continue;
      if (row[to]++ >= room(to) || row[colours]++ >= surplus(from)) continue;
      colour_of[vertices[i]] = to;
      ++went[b * colours + to];
    }
  });
  std::size_t moved = 0;
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t c = 0; c < colours; ++c) {
      size_of_[c] += went[b * colours + c];
      moved += went[b * colours + c];
    }
  size_of_[from] -= moved;
  find_room();
  return moved;
}

}  // namespace ductile::runtime::detail
