/// @file
/// AdaptJob: the command line of `adapt`, checked before any file is read; for the programs that
/// adapt.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapt_report.hpp"
#include "arguments.hpp"
#include "carried_fields.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/executor.hpp"
#include "level_set_option.hpp"
#include "size_options.hpp"

namespace ductile::cli {

struct AdaptJob {
  std::filesystem::path input, output;
  std::optional<std::filesystem::path> metric_in, metric_out, parameters, geometry, json, vtu;
  CarriedFields fields;
  std::string unneeded;  // options of Mmg's
  std::optional<double> size;
  std::vector<std::string> solution;  // a field of the mesh's file, or a file; empty: none
  double elements = 0;                // that a solution is to be resolved by
  meshadapt::Recovery recovery = meshadapt::Recovery::least_squares;
  std::optional<double> join;  // the distance of vertices that become one
  SizeOptions places;
  std::optional<LevelSetOption> level_set;
  std::optional<std::size_t> memory;  // bytes
  meshadapt::AdaptOptions adapt;
  int verbosity = 1;
  int threads = 0;
  bool racing = false;
  bool metric_found = false;  // beside the mesh; before check_files(): no sizes are given
  bool with_metric = true;    // write the metric at the new vertices
  bool keep_sizes = false;    // whatever metric there is with the mesh
};

/// The job that a command line asks for; touches no file. `output` replaces the value of -o. Throws
/// UsageError.
AdaptJob adapt_job(const Arguments& arguments,
                   const std::optional<std::filesystem::path>& output = {});

/// Looks for a metric beside the mesh unless sizes are given. Throws UsageError if an output would
/// replace an input, InputError if outputs cannot be written.
void check_files(AdaptJob& job);

/// The files that the job writes; standard output by its name.
std::vector<std::filesystem::path> outputs_of(const AdaptJob& job);

/// The contents of a job's files, ready to be adapted.
struct AdaptInput {
  meshadapt::MeshWithFields file;
  meshadapt::Sizes sizes;  // by places
  meshadapt::AnyField metric;
  CarriedFields::Values fields;
  MetricInForce in_force;
  std::optional<CutInput> cut;  // with -ls: `file.mesh` and `metric` are those of the cut mesh

  /// The mesh that the fields are on.
  const meshadapt::AnyMesh& mesh_of_fields() const { return cut ? cut->before : file.mesh; }
};

/// Reads a job's files except -geometry, joins vertices, cuts along a level set and bounds the
/// metric. Local parameters may widen the bounds in job.adapt, which also gets the surface of the
/// level set. Throws InputError; UsageError if places do not fit the mesh.
AdaptInput read_input(const runtime::Executor& executor, AdaptJob& job,
                      meshadapt::Warnings& warnings);

/// Bytes that may still be allocated: the given limit, or the machine's memory, minus what is in
/// use; 0 if unknown.
std::size_t memory_left(std::optional<std::size_t> given);

/// An adapted mesh and the data on it.
struct AdaptOutput {
  const meshadapt::AnyMesh& mesh;
  const meshadapt::AnyField& metric;
  const std::vector<meshadapt::NamedField>& fields;
  const std::vector<std::size_t>& field_count_of;  // [file that CarriedFields writes]
  const std::string& json;
};

/// Writes all outputs of a job, or none. Prints the warnings before.
void write_outputs(const AdaptJob& job, const AdaptOutput& output, meshadapt::Warnings& warnings);

/// The metric that a job asks for, at the vertices of the input. Throws InputError.
meshadapt::AnyField choose_metric(const runtime::Executor& executor, const AdaptJob& job,
                                  const meshadapt::MeshWithFields& file,
                                  const meshadapt::Sizes& sizes, meshadapt::Warnings& warnings);

/// The source of that metric in words: "part.sol (found beside the mesh)".
std::string metric_said(const AdaptJob& job, const meshadapt::MeshWithFields& file);

/// The geometry from the mesh of -geometry; null without that option.
std::shared_ptr<const meshadapt::Geometry> read_geometry(const runtime::Executor& executor,
                                                         const AdaptJob& job,
                                                         meshadapt::Warnings& warnings);

/// The options about sizes that are in force.
std::vector<ValueInForce> values_in_force(const AdaptJob& job);

}  // namespace ductile::cli
