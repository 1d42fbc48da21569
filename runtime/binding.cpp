#include "binding.hpp"

#include <hwloc.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace ductile::runtime::detail {

/// The topology, and the processing unit of each thread in order.
class Places {
 public:
  Places(hwloc_topology_t topology, std::vector<hwloc_cpuset_t> units)
      : topology_(topology), units_(std::move(units)) {}
  ~Places() { hwloc_topology_destroy(topology_); }
  Places(const Places&) = delete;
  Places& operator=(const Places&) = delete;

  hwloc_topology_t topology() const { return topology_; }
  std::size_t count() const { return units_.size(); }
  hwloc_cpuset_t unit(std::size_t i) const { return units_[i % units_.size()]; }

 private:
  hwloc_topology_t topology_;
  std::vector<hwloc_cpuset_t> units_;  // owned by the topology
};

namespace {

/// A processing unit with its sort key: packages, cores and hyperthreads are numbered among those
/// that the process may use.
struct Unit {
  hwloc_cpuset_t set;
  std::size_t package, core, hyperthread;
};

std::vector<Unit> usable_units(hwloc_topology_t topology) {
  std::vector<Unit> units;
  std::map<hwloc_obj_t, std::size_t> packages, cores_in_package, core_number, units_in_core;
  const hwloc_bitmap_t mask = hwloc_bitmap_dup(hwloc_topology_get_allowed_cpuset(topology));
  if (mask == nullptr) return units;
  hwloc_get_cpubind(topology, mask, HWLOC_CPUBIND_PROCESS);  // leaves the mask unchanged on failure
  hwloc_obj_t unit = nullptr;
  while ((unit = hwloc_get_next_obj_by_type(topology, HWLOC_OBJ_PU, unit)) != nullptr) {
    if (!hwloc_bitmap_isset(mask, unit->os_index)) continue;
    // Null if the system does not tell: all units then count as one package, or as separate cores.
    hwloc_obj_t package = hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_PACKAGE, unit);
    hwloc_obj_t core = hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_CORE, unit);
    if (core == nullptr) core = unit;
    const std::size_t package_number = packages.try_emplace(package, packages.size()).first->second;
    if (!core_number.contains(core)) core_number[core] = cores_in_package[package]++;
    units.push_back({unit->cpuset, package_number, core_number[core], units_in_core[core]++});
  }
  hwloc_bitmap_free(mask);
  return units;
}

/// Physical cores before their second hyperthreads; compact fills a package before the next,
/// scatter alternates packages.
void order_units(std::vector<Unit>& units, Placement placement) {
  const auto turn = [placement](const Unit& unit) {
    const bool compact = placement == Placement::compact;
    return compact ? std::tuple(unit.hyperthread, unit.package, unit.core)
                   : std::tuple(unit.hyperthread, unit.core, unit.package);
  };
  std::stable_sort(units.begin(), units.end(),
                   [&](const Unit& a, const Unit& b) { return turn(a) < turn(b); });
}

}  // namespace

std::shared_ptr<const Places> make_places(Placement placement) {
  if (placement == Placement::none) return nullptr;
  hwloc_topology_t topology = nullptr;
  if (hwloc_topology_init(&topology) != 0) return nullptr;
  if (hwloc_topology_load(topology) != 0) {
    hwloc_topology_destroy(topology);
    return nullptr;
  }
  std::vector<Unit> units = usable_units(topology);
  order_units(units, placement);
  std::vector<hwloc_cpuset_t> sets;
  sets.reserve(units.size());
  for (const Unit& unit : units) sets.push_back(unit.set);
  auto places = std::make_shared<Places>(topology, std::move(sets));
  return places->count() == 0 ? nullptr : places;
}

std::vector<unsigned> processors(const Places& places) {
  std::vector<unsigned> numbers;
  for (std::size_t i = 0; i < places.count(); ++i)
    numbers.push_back(static_cast<unsigned>(hwloc_bitmap_first(places.unit(i))));
  return numbers;
}

void ScopedBinding::bind(const Places& places, int thread) noexcept {
  hwloc_bitmap_t before = hwloc_bitmap_alloc();
  if (before == nullptr) return;
  const hwloc_topology_t topology = places.topology();
  if (hwloc_get_cpubind(topology, before, HWLOC_CPUBIND_THREAD) != 0 ||
      hwloc_set_cpubind(topology, places.unit(static_cast<std::size_t>(thread)),
                        HWLOC_CPUBIND_THREAD) != 0) {
    hwloc_bitmap_free(before);
    return;
  }
  places_ = &places;
  before_ = before;
}

void ScopedBinding::restore() noexcept {
  const auto before = static_cast<hwloc_bitmap_t>(before_);
  hwloc_set_cpubind(places_->topology(), before, HWLOC_CPUBIND_THREAD);
  hwloc_bitmap_free(before);
}

}  // namespace ductile::runtime::detail
