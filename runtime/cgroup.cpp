#include "cgroup.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace ductile::runtime {

namespace {

using std::filesystem::path;

/// quota / period of one group, from version 2's cpu.max ("max 100000", "150000 100000") or version
/// 1's two files; 0 if there is none.
double cpu_of_group(const path& group) {
  double quota = 0, period = 0;
  if (std::ifstream both(group / "cpu.max"); both) {
    both >> quota >> period;
  } else {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  return quota > 0 && period > 0 ? quota / period : 0;
}

/// Bytes in version 2's memory.max or version 1's file; 0 if there is no limit.
double memory_of_group(const path& group) {
  double memory = 0;
  if (std::ifstream(group / "memory.max") >> memory) return memory;
  memory = 0;
  std::ifstream(group / "memory.limit_in_bytes") >> memory;
  constexpr double none = 1e18;  // version 1 writes the largest number of pages
  return memory < none ? memory : 0;
}

using LimitOfGroup = double (*)(const path& group);

void keep_least(double& limit, double other) {
  if (other > 0 && (limit == 0 || other < limit)) limit = other;
}

/// The least limit from `group`, a path below `hierarchy`, up to the root.
double limit_upwards(const path& hierarchy, path group, LimitOfGroup limit_of_group) {
  double limit = limit_of_group(hierarchy);
  for (; group.has_relative_path(); group = group.parent_path())
    keep_least(limit, limit_of_group(hierarchy / group.relative_path()));
  return limit;
}

bool lists(const std::string& controllers, const std::string& wanted) {
  std::istringstream names(controllers);
  for (std::string name; std::getline(names, name, ',');)
    if (name == wanted) return true;
  return false;
}

double least_limit(const path& mount, const path& membership, const std::string& controller,
                   LimitOfGroup limit_of_group) noexcept {
  double limit = 0;
  try {
    std::ifstream lines(membership);
    for (std::string line; std::getline(lines, line);) {  // number:controllers:/path
      std::istringstream fields(line);
      std::string number, controllers, group;
      std::getline(fields, number, ':');
      std::getline(fields, controllers, ':');
      std::getline(fields, group);
      if (controllers.empty()) keep_least(limit, limit_upwards(mount, group, limit_of_group));
      if (!lists(controllers, controller)) continue;
      keep_least(limit, limit_upwards(mount / controllers, group, limit_of_group));
      keep_least(limit, limit_upwards(mount / controller, group, limit_of_group));
    }
  } catch (...) {
    return 0;  // treat an unreadable machine as unlimited
  }
  return limit;
}

}  // namespace

double cgroup_cpu_limit(const path& mount, const path& membership) noexcept {
  return least_limit(mount, membership, "cpu", cpu_of_group);
}

double cgroup_memory_limit(const path& mount, const path& membership) noexcept {
  return least_limit(mount, membership, "memory", memory_of_group);
}

}  // namespace ductile::runtime
