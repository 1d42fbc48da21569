/// @file
/// What the commands share about files: reading a mesh with its metric, the names that outputs get
/// by default, and warnings on standard error.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_operations.hpp"

namespace ductile::cli {

/// Prints each as "ductile: warning: ..." on standard error, unless `verbosity` is 0.
void print_warnings(const meshadapt::Warnings& warnings, int verbosity = 1);

/// The metric file beside a mesh: NAME.sol, else NAME.solb, if it is there. Throws InputError where
/// it is not, because a run was killed while it replaced it.
std::optional<std::filesystem::path> metric_beside(const std::filesystem::path& mesh);

/// NAME.o.mesh or NAME.o.meshb beside the input, binary as it is.
std::filesystem::path default_output(const std::filesystem::path& mesh);

/// The same name with the ending of a field: .sol, or .solb for a .meshb.
std::filesystem::path field_beside(const std::filesystem::path& mesh);

/// Throws UsageError if an output that is none of its kind would take the place of an input.
void expect_no_input(const std::filesystem::path& output,
                     const std::vector<std::filesystem::path>& inputs);

/// Reads a field and checks that it is a metric of this mesh, within bounds that hold before.
meshadapt::AnyField read_metric(const std::filesystem::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings,
                                const meshadapt::SizeBounds& bounds = {});

/// Reads fields at the vertices and checks that they are of this mesh.
meshadapt::AnyField read_fields(const std::filesystem::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings);

/// The text with a '?' for each byte that is not UTF-8, as a file's name may have: for what must
/// be.
std::string as_utf8(const std::string& text);

/// 1234567 as "1,234,567".
std::string with_commas(std::size_t number);

}  // namespace ductile::cli
