/// @file
/// Input of `ductile-mpi adapt` from command line and files: the first rank reads it and sends the
/// others what they need.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "adapt/sizes_by_places.hpp"
#include "adapt_job.hpp"
#include "communicator.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/executor.hpp"
#include "file_part.hpp"

namespace ductile::petsc {

/// An option of `ductile adapt` that is not available on several ranks, and its alternative.
struct NotHere {
  std::string_view option, instead;
};
inline constexpr std::array<NotHere, 3> not_here{
    {{"--racing", "results are the same each time here; use ductile adapt"},
     {"--json", "use ductile info --json of the adapted mesh"},
     {"--vtu", "use -o OUT.pvtu, or ductile convert of the adapted mesh"}}};

enum class Form { gathered, pieces, hdf5 };

/// The input, in the order in which it is read. Other ranks only know the types of fields, the
/// first one all.
struct Input {
  cli::AdaptJob job;
  std::filesystem::path output;
  Form form = Form::gathered;
  FilePart file;
  std::optional<meshadapt::SizesByPlaces> places;
  std::optional<Part> geometry;  // the mesh of -geometry
  std::vector<meshadapt::NamedField> fields;
  std::vector<std::size_t> field_count_of;  // [file given by --field]
  std::vector<meshadapt::ReferenceName> names;
  int dropped_axis = 2;
  meshadapt::Warnings warnings;
};

/// Reads the command line. On the first rank. Throws UsageError, and InputError if outputs cannot
/// be written.
void read_words(Input& input, const cli::Arguments& arguments);

/// Reads the job's files. On the first rank. Throws InputError.
void read_files(Input& input, const runtime::Executor& executor);

/// Sends the other ranks what they need. Throws Error, on all ranks. Collective.
void tell_others(const Communicator& comm, Input& input);

}  // namespace ductile::petsc
