/// @file
/// Places of outputs (private to io): where a name leads, whether a file may be put there, and
/// names for files that are on their way, `NAME.ductile-tmp-PID-N` and `NAME.ductile-old-PID-N`.
#pragma once

#include <cstdio>
#include <filesystem>

namespace ductile::meshadapt {

/// The folder of a file, "." if it is named without.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// True for outputs that no file may replace: a device, a pipe, or a name such as /dev/stdout or
/// /dev/fd/3 for something that this process has open.
bool is_written_directly(const std::filesystem::path& path);

/// Opens such an output; null, and why in errno, if that fails.
std::FILE* open_directly(const std::filesystem::path& path);

/// The file to write for an output: itself, or the end of a chain of symbolic links.
std::filesystem::path file_of(const std::filesystem::path& path);

/// A path that is the same for all names of one file, which need not exist yet.
std::filesystem::path place_of(const std::filesystem::path& path);

/// Throws InputError unless an output may go there, as far as can be said without trying.
void expect_usable_name(const std::filesystem::path& path);

/// Throws InputError because two outputs have one place.
[[noreturn]] void refuse_second_output(const std::filesystem::path& path);

/// Makes an empty file beside `path` under a new name and returns that. Throws InputError.
std::filesystem::path create_beside(const std::filesystem::path& path, const char* kind);

}  // namespace ductile::meshadapt
