/// @file
/// Files for all commands: reading a mesh with its metric, default names of outputs, and warnings
/// on standard error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"
#include "report.hpp"

namespace ductile::cli {

/// Prints each as "ductile: warning: ..." on standard error, unless `verbosity` is 0.
void print_warnings(const Warnings& warnings, int verbosity = 1);

/// The metric file beside a mesh: NAME.sol, otherwise NAME.solb, if there is one. Throws InputError
/// if it is missing because a run was killed while it replaced it.
std::optional<fs::path> metric_beside(const fs::path& mesh);

/// NAME.o.ENDING beside the input, in its format if that can be written, otherwise a .mesh.
fs::path default_output(const fs::path& mesh);

/// The name of a mesh with the ending of a field: .sol, or .solb for a .meshb.
fs::path field_beside(const fs::path& mesh);

/// The file to read for a word of the command line; "-" is standard input.
fs::path input_of(const std::string& word);

/// The output for a word of the command line. "-.ENDING" is standard output in the format of that
/// ending, and "-" is "-.mesh".
fs::path output_of(const std::string& word);
bool is_standard_output(const fs::path& output);
/// The file to be written, /dev/stdout for standard output.
fs::path place_of(const fs::path& output);

/// Throws UsageError unless a mesh can be written to a file of this name.
void expect_mesh_name(const fs::path& path);

/// True if files of this name hold a mesh and fields.
bool holds_fields(const fs::path& path);
/// True if files of this name hold fields at vertices alone.
bool holds_field(const fs::path& path);
/// Throws UsageError about -o unless files of this name hold fields.
void expect_fields_held(const fs::path& path);

/// The field "metric" in the file of a mesh, if there is one: at the vertices, or the means of its
/// values on the elements around them.
std::optional<AnyField> metric_in(const MeshWithFields& file);

/// Throws UsageError if an output would replace an input.
void expect_no_input(const fs::path& output, const std::vector<fs::path>& inputs);

/// Reads a field and checks that it is a metric of this mesh, within bounds that hold before. Of a
/// file that holds a mesh and fields: the one called "metric", or the only one.
AnyField read_metric(const fs::path& path, const AnyMesh& mesh, Warnings& warnings,
                     const SizeBounds& bounds = {});

/// All fields of a file, at vertices and on elements, by name. Those of a .sol are called like the
/// file, NAME, or NAME_1, NAME_2, ... if there are several. Checks that they are of this mesh.
std::vector<NamedField> read_named_fields(const fs::path& path, const AnyMesh& mesh,
                                          Warnings& warnings);

/// The fields of a file at vertices, at least one, without a metric beside others: a mesh was
/// adapted to that, so it is no solution. A single field is called like the file.
std::vector<NamedField> read_solutions(const fs::path& path, const AnyMesh& mesh,
                                       Warnings& warnings);

/// True if a word names a file of fields, not one field.
bool is_file(const std::string& word);

/// The fields that a metric is made of: `words` are names of fields at the vertices of this mesh,
/// or a file and names of fields in it. Without names there must be one alone, beside a metric; of
/// a .sol, which has no names, all are taken, with a warning. Throws InputError with the names that
/// there are.
std::vector<NamedField> chosen_solutions(const std::vector<std::string>& words,
                                         const MeshWithFields& mesh, Warnings& warnings);

/// Warns of hanging and doubled vertices, where the mesh is not connected.
void warn_of_loose_vertices(const runtime::Executor& executor, const AnyMesh& mesh,
                            Warnings& warnings);

/// The value of --join: the distance of vertices that become one. Throws UsageError.
std::optional<double> join_option(const Arguments& arguments);
/// Joins vertices within a distance, says how many in a warning, and returns those that are kept.
std::vector<std::uint32_t> join(AnyMesh& mesh, double distance, Warnings& warnings);
/// Leaves the values at vertices that were kept.
void keep_at(const std::vector<std::uint32_t>& kept, std::vector<NamedField>& fields,
             int dimension);

/// The mesh of a command line that has one, also by Mmg's -in. Throws UsageError, with a hint if
/// there are two.
fs::path only_mesh(const Arguments& arguments, const char* hint = "");

/// Standard output as the word for a file, for example of --json: "-".
inline constexpr const char* standard_output = "-";
/// Writes to a file as one of the outputs, or to standard output at once.
void put_json(AtomicOutputs& outputs, const fs::path& place, const std::string& json);

/// The fields at the vertices of a mesh, at least one, as one field.
AnyField side_by_side(const std::vector<NamedField>& fields, const AnyMesh& mesh);

/// Their names, "u, p", for messages.
std::string names_of(const std::vector<NamedField>& fields);

bool is_at_vertices(const NamedField& field);
/// Those at vertices. Throws InputError, which begins with `source`, if there are none.
std::vector<NamedField> at_vertices(std::vector<NamedField> fields, const std::string& source);

}  // namespace ductile::cli
