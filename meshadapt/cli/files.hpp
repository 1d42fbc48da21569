/// @file
/// What the commands share about files: reading a mesh with its metric, the names that outputs get
/// by default, and warnings on standard error.
#pragma once

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

namespace ductile::cli {

/// Prints each as "ductile: warning: ..." on standard error, unless `verbosity` is 0.
void print_warnings(const meshadapt::Warnings& warnings, int verbosity = 1);

/// The metric file beside a mesh: NAME.sol, else NAME.solb, if it is there. Throws InputError where
/// it is not, because a run was killed while it replaced it.
std::optional<std::filesystem::path> metric_beside(const std::filesystem::path& mesh);

/// NAME.o.ENDING beside the input, of its format if that can be written, else a .mesh.
std::filesystem::path default_output(const std::filesystem::path& mesh);

/// The same name with the ending of a field: .sol, or .solb for a .meshb.
std::filesystem::path field_beside(const std::filesystem::path& mesh);

/// What is read for a word of the command line: "-" is standard input.
std::filesystem::path input_of(const std::string& word);

/// Where a mesh goes for a word of the command line. "-.ENDING" is standard output, in the format
/// of that ending, and "-" the same as "-.mesh".
std::filesystem::path output_of(const std::string& word);
bool is_standard_output(const std::filesystem::path& output);
/// The file to be written, /dev/stdout for standard output.
std::filesystem::path place_of(const std::filesystem::path& output);

/// Throws UsageError unless a mesh can be written to a file of this name.
void expect_mesh_name(const std::filesystem::path& path);

/// Whether files of this name hold a mesh and fields.
bool holds_fields(const std::filesystem::path& path);

/// The field "metric" that a file has beside its mesh, if it has one: at the vertices, or on
/// elements, of which vertices get the means.
std::optional<meshadapt::AnyField> metric_in(const meshadapt::MeshWithFields& file);

/// Throws UsageError if an output that is none of its kind would take the place of an input.
void expect_no_input(const std::filesystem::path& output,
                     const std::vector<std::filesystem::path>& inputs);

/// Reads a field and checks that it is a metric of this mesh, within bounds that hold before. Of a
/// file that holds a mesh and fields: the one called "metric", or the only one.
meshadapt::AnyField read_metric(const std::filesystem::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings,
                                const meshadapt::SizeBounds& bounds = {});

/// Reads fields at the vertices, all that there are in a file, and checks that they are of this
/// mesh.
meshadapt::AnyField read_fields(const std::filesystem::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings);

/// All fields of a file, at vertices and on elements, by name. Those of a .sol are called like the
/// file, NAME, or NAME_1, NAME_2, ... if there are several. Checks that they are of this mesh.
std::vector<meshadapt::NamedField> read_named_fields(const std::filesystem::path& path,
                                                     const meshadapt::AnyMesh& mesh,
                                                     meshadapt::Warnings& warnings);

/// Of those, the ones at vertices, of which there is at least one, except a metric beside others:
/// it says what the mesh was adapted to and is no solution. One alone is called like the file.
std::vector<meshadapt::NamedField> read_solutions(const std::filesystem::path& path,
                                                  const meshadapt::AnyMesh& mesh,
                                                  meshadapt::Warnings& warnings);

/// Whether a word stands for a file of fields, not for one field by name.
bool is_file(const std::string& word);

/// The fields that a metric is made of: `words` are names of fields at the vertices of this mesh,
/// or a file and names of fields in it. Without names there must be one alone, beside a metric; of
/// a .sol, which has no names, all are taken, with a warning. Throws InputError with the names that
/// there are.
std::vector<meshadapt::NamedField> chosen_solutions(const std::vector<std::string>& words,
                                                    const meshadapt::MeshWithFields& mesh,
                                                    meshadapt::Warnings& warnings);

/// Warns of vertices that hang or are doubled, where the mesh is not connected.
void warn_of_loose_vertices(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                            meshadapt::Warnings& warnings);

/// Standard output as the word for a file: "-".
inline constexpr const char* standard_output = "-";
/// What --json says: a file, or standard_output.
std::optional<std::filesystem::path> json_output(const Arguments& arguments);
/// Writes to a file as one of the outputs, or to standard output at once.
void put_json(meshadapt::AtomicOutputs& outputs, const std::filesystem::path& place,
              const std::string& json);

/// Fields at the vertices of a mesh, of which there is at least one, side by side.
meshadapt::AnyField side_by_side(const std::vector<meshadapt::NamedField>& fields,
                                 const meshadapt::AnyMesh& mesh);

/// Their names, "u, p", for messages.
std::string names_of(const std::vector<meshadapt::NamedField>& fields);

bool is_at_vertices(const meshadapt::NamedField& field);

/// The text with a '?' for each byte that is not UTF-8, as a file's name may have: for what must
/// be.
std::string as_utf8(const std::string& text);

/// 1234567 as "1,234,567".
std::string with_commas(std::size_t number);
/// "1 vertex", "1,234 vertices".
std::string counted(std::size_t number, const char* one, const char* many);

}  // namespace ductile::cli
