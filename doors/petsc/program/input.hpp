/// @file
/// Input of `ductile-mpi adapt`. All ranks read the command line; the first one reads the files and
/// sends the others what they need.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "adapt/sizes_by_places.hpp"
#include "adapt_job.hpp"
#include "distributed/communicator.hpp"
#include "distributed/file_part.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::petsc {

using namespace distributed;

enum class Form { gathered, pieces, hdf5 };

/// The input, in the order in which it is read. Ranks other than the first know an empty part, and
/// fields without values.
struct Input {
  cli::AdaptJob job;
  std::filesystem::path output;
  Form form = Form::gathered;
  FilePart file;
  std::optional<meshadapt::SizesByPlaces> places;
  std::optional<Part> geometry;  // the mesh of -geometry
  std::vector<meshadapt::NamedField> fields;
  std::vector<std::size_t> field_count_of;  // [file given by --field]
  meshadapt::Warnings warnings;
};

/// Reads the command line; touches no file. Throws UsageError.
Input read_words(const cli::Arguments& arguments);

/// Does what cli::check_files() does, for the output in any form. On the first rank.
void check_files(Input& input);

/// Reads the job's files. On the first rank. Throws InputError.
void read_files(Input& input, const runtime::Executor& executor);

/// Sends the other ranks what they need. Throws Error, on all ranks. Collective.
void tell_others(const Communicator& comm, Input& input);

}  // namespace ductile::petsc
