/// @file
/// Limits that control groups set for this process (private to the runtime).
#pragma once

#include <filesystem>

namespace ductile::runtime {

/// Number of processors whose time cgroups (version 1 or 2) allow: the least over the groups from
/// the process's own up to the root; 0 if unlimited or unreadable. `membership` is like
/// /proc/self/cgroup, `mount` like /sys/fs/cgroup. Never throws.
double cgroup_cpu_limit(const std::filesystem::path& mount,
                        const std::filesystem::path& membership) noexcept;

/// The same for bytes of memory, without swap.
double cgroup_memory_limit(const std::filesystem::path& mount,
                           const std::filesystem::path& membership) noexcept;

}  // namespace ductile::runtime
