/// @file
/// TileRounds: the strategy `tiles`. Each round runs its work in tiles (tiles.hpp). Items that were
/// woken after their turn, postponed or late are the next round's work.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/tiles.hpp"
#include "ductile/runtime/detail/woken_items.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

template <ConflictingOperator Op>
class TileRounds {
 public:
  using Item = std::uint32_t;

  TileRounds(const Executor& executor, Op& op)
      : executor_(executor), op_(op), woken_(executor, op.resource_count()) {}

  /// Work has size() and items by [i].
  RoundsReport run(const auto& work, std::size_t most_rounds) {
    UnsetVector<Item> next = known_items(executor_, work, woken_.turns().size());
    while (!next.empty() && report_.rounds < most_rounds) next = run_round(next);
    report_.left = next.size();
    return report_;
  }

 private:
  UnsetVector<Item> run_round(std::span<const Item> all) {
    ++report_.rounds;
    ++report_.batches;
    woken_.begin_round();
    const auto work = all.first(std::min<std::size_t>(all.size(), Turns::most_items));
    run_tiles(work);
    const PhaseTimer timer(report_.wake_seconds);
    parallel_for(
        executor_, work.size(),
        [&](std::size_t i) { woken_.turns()[work[i]] = WokenItems::absent; }, few_nanoseconds);
    for (const Item item : all.subspan(work.size())) woken_.bring_back(item);
    return woken_.take();
  }

  void run_tiles(std::span<const Item> work) {
    std::optional<Tiles<Op>> tiles;
    {
      const PhaseTimer timer(report_.conflict_seconds);
      tiles.emplace(executor_, op_, work, woken_);
    }
    const PhaseTimer timer(report_.apply_seconds);
    tiles->run();
    const auto [planned, applied] = tiles->counts();
    report_.planned += planned;
    report_.applied += applied;
    report_.lost += work.size() - planned;
  }

  const Executor& executor_;
  Op& op_;
  WokenItems woken_;
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
