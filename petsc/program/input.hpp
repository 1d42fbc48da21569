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
#include "ductile/runtime/executor.hpp"
#include "file_part.hpp"

namespace ductile::petsc {

/// Options of `ductile adapt` that need all of a mesh in one place, or one order of events.
inline constexpr std::array<std::string_view, 6> not_here{"--near",   "--on",   "--inside",
                                                          "--racing", "--json", "--vtu"};

enum class Form { gathered, pieces, hdf5 };

/// What files say, in the order in which it is made. Only the form is known on every rank, the
/// rest on the first one.
struct Input {
  cli::AdaptJob job;
  std::filesystem::path output;
  Form form = Form::gathered;
  FilePart file;
  std::optional<Part> geometry;  // of the mesh that -geometry names
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
