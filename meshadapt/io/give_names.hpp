/// @file
/// give_names: the last step of outputs that belong together, such that no reader takes old and new
/// ones for a unit, whenever the process is killed (private to io). Files that are on their way
/// have names beside their places, `NAME.ductile-tmp-PID-N` and, if they are to go, `-old-`.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace ductile::meshadapt {

/// A file that is complete and on disk, under a name that is not the one it is to have.
struct CompleteFile {
  std::filesystem::path now, wanted;
};

/// Moves each file to its place. What was in the places of all but the first is set aside before
/// that, and removed in the end: whoever finds the first finds the others of its unit, or none.
/// Throws Error if a file cannot be moved; what was set aside is in its place again then, and the
/// text names the new files that are in place. Call it while signals are held.
void give_names(const std::vector<CompleteFile>& unit);

/// The name of a new file beside `path`. create(name) makes it, or says no and why in errno; not if
/// there is one, so that no two writers share one. Throws InputError.
std::filesystem::path create_beside(
    const std::filesystem::path& path, const char* kind,
    const std::function<bool(const std::filesystem::path& name)>& create);

/// Sees to it that what has been written is on disk. False if it cannot be, and why in errno.
bool bring_to_disk(int descriptor);

/// The folder of a file, "." if it is named without.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace ductile::meshadapt
