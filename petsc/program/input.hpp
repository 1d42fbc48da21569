/// @file
/// What the command line and the files of `ductile-mpi adapt` say: the first rank reads them, and
/// the others hear what they have to know.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "adapt_job.hpp"
#include "communicator.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/executor.hpp"
#include "file_part.hpp"

namespace ductile::petsc {

/// An option of `ductile adapt` that there is not on several ranks, and what does the same.
struct NotHere {
  std::string_view option, instead;
};
inline constexpr std::array<NotHere, 3> not_here{
    {{"--racing", "results are the same each time here; use ductile adapt"},
     {"--json", "use ductile info --json of the adapted mesh"},
     {"--vtu", "use -o OUT.pvtu, or ductile convert of the adapted mesh"}}};

enum class Form { gathered, pieces, hdf5 };

/// What files say, in the order in which it is made. Only the form is known on every rank, the
/// rest on the first one.
struct Input {
  cli::AdaptJob job;
  std::filesystem::path output;
  Form form = Form::gathered;
  FilePart file;
  std::optional<meshadapt::Sizes> sizes;  // by places, for the meshes that come of the file's
  std::optional<Part> geometry;           // of the mesh that -geometry names
  std::vector<meshadapt::NamedField> fields;
  std::vector<std::size_t> field_count_of;  // [file given by --field]
  std::vector<meshadapt::ReferenceName> names;
  int dropped_axis = 2;
  meshadapt::Warnings warnings;
};

/// What the command line says. On the first rank. Throws UsageError, and InputError where outputs
/// cannot be written.
void read_words(Input& input, const cli::Arguments& arguments);

/// Reads the files that the job names. On the first rank. Throws InputError.
void read_files(Input& input, const runtime::Executor& executor);

/// Tells the other ranks what they have to know of it. Throws Error, on all ranks. Collective.
void tell_others(const Communicator& comm, Input& input);

}  // namespace ductile::petsc
