#include "cgroup.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace ductile::runtime {

namespace {

using std::filesystem::path;

/// quota / period of one group in version 2's cpu.max ("max 100000", "150000 100000") or version
/// 1's two files; 0 if there is none.
double limit_of_group(const path& group) {
  double quota = 0, period = 0;
  if (std::ifstream both(group / "cpu.max"); both) {
    both >> quota >> period;
  } else {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  return quota > 0 && period > 0 ? quota / period : 0;
}

void keep_least(double& limit, double other) {
  if (other > 0 && (limit == 0 || other < limit)) limit = other;
}

/// The least limit from `group`, below `hierarchy`, up to the hierarchy's root.
double limit_upwards(const path& hierarchy, path group) {
  double limit = limit_of_group(hierarchy);
  for (; group.has_relative_path(); group = group.parent_path())
    keep_least(limit, limit_of_group(hierarchy / group.relative_path()));
  return limit;
}

bool lists_cpu(const std::string& controllers) {
  std::istringstream names(controllers);
  for (std::string name; std::getline(names, name, ',');)
    if (name == "cpu") return true;
  return false;
}

}  // namespace

double cgroup_cpu_limit(const path& mount, const path& membership) noexcept {
  double limit = 0;
  try {
    std::ifstream lines(membership);
    for (std::string line; std::getline(lines, line);) {  // number:controllers:/path
      std::istringstream fields(line);
      std::string number, controllers, group;
      std::getline(fields, number, ':');
      std::getline(fields, controllers, ':');
      std::getline(fields, group);
      if (controllers.empty()) keep_least(limit, limit_upwards(mount, group));
      if (!lists_cpu(controllers)) continue;
      keep_least(limit, limit_upwards(mount / controllers, group));
      keep_least(limit, limit_upwards(mount / "cpu", group));
    }
  } catch (...) {
    return 0;  // a machine that cannot be read sets no limit
  }
  return limit;
}

}  // namespace ductile::runtime
