/// @file
/// RegionRounds: the strategy `regions`. In each phase resources are cut into regions, by their
/// places, or by their numbers if the operator has no place_of(). One thread runs the items of a
/// region, the last woken first, and writes directly, because all that its items reach belongs to
/// it. An item that reaches into another region waits for the next phase, whose cuts lie elsewhere.
/// The number of regions depends on the amount of work, never on threads, and so does the result.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/detail/region_map.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// place_of(resource), or the number of the resource.
template <Operator Op>
auto place_in(const Op& op, std::uint32_t resource) {
  if constexpr (PlacedOperator<Op>) {
    return op.place_of(resource);
  } else {
    return std::array<double, 1>{static_cast<double>(resource)};
  }
}

template <Operator Op>
class RegionRounds {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  RegionRounds(const Executor& executor, Op& op) : executor_(executor), op_(op), made_(op) {}

  RoundsReport run(std::vector<Item> work, std::size_t most_phases) {
    while (!work.empty() && report_.rounds < most_phases) {
      ++report_.rounds;
      const std::size_t items = work.size(), before = report_.applied;
      const std::size_t count = region_count(items);
      work = count == 1 ? run_one_by_one(std::move(work)) : run_phase(work, count);
      report_.lost += work.size();
      is_stuck_ = 2 * work.size() > items;
      is_hopeless_ = 16 * (report_.applied - before) < items;
    }
    report_.left = work.size();
    const PhaseTimer timer(report_.wake_seconds);
    made_.close_holes();
    return report_;
  }

 private:
  using Map = RegionMap<std::tuple_size_v<decltype(place_in(std::declval<const Op&>(), 0))>>;
  using RegionNumber = typename Map::Region;
  using Pools = typename MadeThings<Op>::Pools;

  // Few regions in late phases, because most remaining items lie at borders.
  static constexpr std::size_t least_resources = 8192, least_items = 64, most_regions = 256,
                               late_regions = 32, few_items = 1024;

  struct alignas(128) Region {
    std::vector<Item> stack, later;
    Pools pools;
    std::size_t planned = 0, applied = 0;
  };

  /// Denies resources of other regions.
  struct ReachOwn {
    const Map& map;
    RegionNumber region;
    bool denied = false;
    bool operator()(std::uint32_t resource) {
      if (map.owner_of(resource) == region) [[likely]]
        return true;
      denied = true;
      return false;
    }
  };
  /// Finds the first resource that an item reaches for.
  struct ReachFirst {
    static constexpr std::uint32_t nothing = 0xffffffffU;
    std::uint32_t first = nothing;
    bool operator()(std::uint32_t resource) {
      if (first == nothing) first = resource;
      return false;
    }
  };

  struct RegionCommit {
    Region& region;
    Map& map;
    RegionNumber number;
    void wake(const Item& item) { region.stack.push_back(item); }
    void postpone(const Item& item) { wake(item); }
    std::uint32_t fresh(std::size_t kind = 0) requires(MadeThings<Op>::kinds > 0) {
      const std::uint32_t taken = region.pools[kind].take();
      if (kind == 0) map.set_owner(taken, number);
      return taken;
    }
  };
  struct OneByOneCommit {
    Region& region;
    void wake(const Item& item) { region.stack.push_back(item); }
    void postpone(const Item& item) { wake(item); }
    std::uint32_t fresh(std::size_t kind = 0) requires(MadeThings<Op>::kinds > 0) {
      return region.pools[kind].take();
    }
  };

  std::size_t region_count(std::size_t items) const {
    // Cutting all resources takes longer than running a few items one by one.
    if (items < std::max(few_items, made_.resources().used() / 512)) return 1;
    if (is_stuck_ && (is_hopeless_ || items < 16 * few_items)) return 1;
    const std::size_t most = report_.rounds > 2 ? late_regions : most_regions;
    const std::size_t count =
        std::min({most, made_.resources().used() / least_resources, items / least_items});
    return count < 4 ? 1 : count;
  }

  /// Runs serially until the work list is long enough to cut into regions, or empty.
  std::vector<Item> run_one_by_one(std::vector<Item> work) {
    const PhaseTimer timer(report_.apply_seconds);
    const std::size_t used = made_.resources().used();
    const std::size_t enough = std::max(4 * least_resources, 2 * used);
    Region region;
    region.stack = std::move(work);
    OneByOneCommit commit{region};
    ReachAll reach;
    Plan plan;
    std::size_t dealt = 0;
    const auto taken = [&] { return dealt - room_left(region); };
    while (!region.stack.empty()) {
      if (used + taken() >= enough && region.stack.size() >= few_items) break;
      const Item item = region.stack.back();
      region.stack.pop_back();
      ++region.planned;
      if (!op_.plan(item, plan, reach)) continue;
      while (!has_room(op_, region.pools, plan)) {
        const std::size_t more = used / 2 + taken() + few_items;
        deal({&region, 1}, [&](std::size_t) { return more; });
        dealt += more;
      }
      op_.apply(item, plan, commit);
      ++region.applied;
    }
    gather({&region, 1});
    return std::move(region.stack);
  }
  static std::size_t room_left(const Region& region) {
    if constexpr (MadeThings<Op>::kinds > 0) {
      return region.pools[0].left();
    } else {
      return 0;
    }
  }

  std::vector<Item> run_phase(const std::vector<Item>& work, std::size_t count) {
    std::vector<Region> regions(count);
    {
      const PhaseTimer timer(report_.conflict_seconds);
      map_.cut(executor_, made_.resources(), [&](std::uint32_t r) { return place_in(op_, r); },
               {count, report_.rounds, report_.applied - applied_before_cut_, is_stuck_});
      applied_before_cut_ = report_.applied;
      share_out(work, regions);
      // A region that gets too few continues in the next phase.
      const std::size_t an_item = report_.rounds == 1 ? 3 : 8;
      deal(regions, [&](std::size_t r) { return an_item * regions[r].stack.size() + few_items; });
    }
    {
      const PhaseTimer timer(report_.apply_seconds);
      parallel_for(executor_, count,
                   [&](std::size_t r) { run_region(regions[r], static_cast<RegionNumber>(r)); },
                   {.grain = 1});
    }
    const PhaseTimer timer(report_.wake_seconds);
    return gather(regions);
  }

  void run_region(Region& region, RegionNumber number) {
    Plan plan;
    RegionCommit commit{region, map_, number};
    while (!region.stack.empty()) {
      const Item item = region.stack.back();
      region.stack.pop_back();
      ReachOwn reach{map_, number};
      ++region.planned;
      const bool found = op_.plan(item, plan, reach);
      if (reach.denied) {
        region.later.push_back(item);
      } else if (found) {
        if (!has_room(op_, region.pools, plan)) {
          region.later.push_back(item);
          break;
        }
        op_.apply(item, plan, commit);
        ++region.applied;
      }
    }
    region.later.insert(region.later.end(), region.stack.begin(), region.stack.end());
  }

  /// Gives each item to the region of the resource it reaches for first, in the order of the work.
  /// An item that reaches for nothing has nothing to do.
  void share_out(const std::vector<Item>& work, std::span<Region> regions) {
    constexpr std::size_t parts = 64;
    constexpr RegionNumber nowhere = 0xffff;
    const std::size_t part_size = work.size() / parts + 1;
    UnsetVector<RegionNumber> region_of(work.size());
    std::vector<std::uint32_t> counts(parts * regions.size());  // [part][region]
    parallel_for_blocks(executor_, work.size(), part_size,
                        [&](std::size_t part, std::size_t begin, std::size_t end) {
                          Plan plan;
                          for (std::size_t i = begin; i < end; ++i) {
                            ReachFirst reach;
                            if (op_.plan(work[i], plan, reach))
                              throw std::logic_error(
                                  "plan() returns true though it has reached for nothing, or "
                                  "reach() returned false");
                            region_of[i] = reach.first == ReachFirst::nothing
                                               ? nowhere
                                               : map_.owner_of(reach.first);
                            if (region_of[i] != nowhere)
                              ++counts[part * regions.size() + region_of[i]];
                          }
                        });
    parallel_for(executor_, regions.size(),
                 [&](std::size_t r) {
                   std::uint32_t before = 0;
                   for (std::size_t part = 0; part < parts; ++part)
                     before += std::exchange(counts[part * regions.size() + r], before);
                   regions[r].stack.resize(before);
                 },
                 {.grain = 1});
    parallel_for_blocks(
        executor_, work.size(), part_size,
        [&](std::size_t part, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i)
            if (region_of[i] != nowhere)
              regions[region_of[i]].stack[counts[part * regions.size() + region_of[i]]++] = work[i];
        });
  }

  void deal(std::span<Region> regions, auto&& wanted_by) {
    made_.deal(
        regions.size(), [&](std::size_t r) -> Pools& { return regions[r].pools; }, wanted_by);
    map_.make_room(made_.resources().top());
  }

  std::vector<Item> gather(std::span<Region> regions) {
    made_.take_back(regions.size(), [&](std::size_t r) -> Pools& { return regions[r].pools; });
    std::vector<Item> work;
    for (const Region& region : regions) {
      work.insert(work.end(), region.later.begin(), region.later.end());
      report_.planned += region.planned;
      report_.applied += region.applied;
    }
    return work;
  }

  const Executor& executor_;
  Op& op_;
  MadeThings<Op> made_;
  Map map_;
  std::size_t applied_before_cut_ = 0;
  bool is_stuck_ = false;     // most items of the last phase are left
  bool is_hopeless_ = false;  // and few were applied, because plans want more numbers than they get
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
