/// @file
/// The share of the machine that control groups leave to this process (private to the runtime).
#pragma once

#include <filesystem>

namespace ductile::runtime {

/// Processors' worth of time per time that cgroups, version 1 or 2, allow: the least over the
/// groups from the process's own up to the root; 0 if there is no limit or nothing to be read.
/// `membership` is like /proc/self/cgroup, `mount` like /sys/fs/cgroup. Never throws.
double cgroup_cpu_limit(const std::filesystem::path& mount,
                        const std::filesystem::path& membership) noexcept;

/// The same of bytes of memory, without what is swapped out.
double cgroup_memory_limit(const std::filesystem::path& mount,
                           const std::filesystem::path& membership) noexcept;

}  // namespace ductile::runtime
