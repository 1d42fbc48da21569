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
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "level_set_option.hpp"
#include "mesh_job.hpp"
#include "size_options.hpp"

namespace ductile::cli {

struct AdaptJob : MeshJob {
  std::optional<fs::path> parameters, geometry;
  std::string unneeded;               // options of Mmg's
  std::vector<std::string> solution;  // a field of the mesh's file, or a file; empty: none
  double elements = 0;                // that a solution is to be resolved by
  Recovery recovery = Recovery::least_squares;
  std::optional<double> join;  // the distance of vertices that become one
  SizeOptions places;
  std::optional<LevelSetOption> level_set;
  std::optional<std::size_t> memory;  // bytes
  AdaptOptions adapt;
  bool racing = false;
  bool metric_found = false;  // beside the mesh; before check_files(): no sizes are given
  bool keep_sizes = false;    // whatever metric there is with the mesh
};

/// The job that a command line asks for; touches no file. `output` replaces the value of -o. Throws
/// UsageError.
AdaptJob adapt_job(const Arguments& arguments, const std::optional<fs::path>& output = {});

/// Looks for a metric beside the mesh unless sizes are given. Throws UsageError if an output would
/// replace an input, InputError if outputs cannot be written.
void check_files(AdaptJob& job);

/// The contents of a job's files, ready to be adapted.
struct AdaptInput {
  MeshWithFields file;
  Sizes sizes;  // by places
  AnyField metric;
  CarriedFields::Values fields;
  MetricInForce in_force;
  std::optional<CutInput> cut;  // with -ls: `file.mesh` and `metric` are those of the cut mesh

  /// The mesh that the fields are on.
  const AnyMesh& mesh_of_fields() const { return cut ? cut->before : file.mesh; }
};

/// Reads a job's files except -geometry, joins vertices, cuts along a level set and bounds the
/// metric. Local parameters may widen the bounds in job.adapt, which also gets the surface of the
/// level set. Throws InputError; UsageError if places do not fit the mesh.
AdaptInput read_input(const runtime::Executor& executor, AdaptJob& job, Warnings& warnings);

/// Bytes that may still be allocated: the given limit, or the machine's memory, minus what is in
/// use; 0 if unknown.
std::size_t memory_left(std::optional<std::size_t> given);

/// The metric that a job asks for, at the vertices of the input. Throws InputError.
AnyField choose_metric(const runtime::Executor& executor, const AdaptJob& job,
                       const MeshWithFields& file, const Sizes& sizes, Warnings& warnings);

/// The source of that metric in words, and the options about sizes that are in force.
MetricInForce metric_in_force(const AdaptJob& job, const MeshWithFields& file);

/// The geometry from the mesh of -geometry; null without that option.
std::shared_ptr<const Geometry> read_geometry(const runtime::Executor& executor,
                                              const AdaptJob& job, Warnings& warnings);

}  // namespace ductile::cli
