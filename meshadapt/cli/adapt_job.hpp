/// @file
/// AdaptJob: the command line of `adapt`, checked before any file is read; for the programs that
/// adapt.
#pragma once

#include <cstddef>
#include <filesystem>
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
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/executor.hpp"
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
  std::optional<std::size_t> memory;  // bytes
  meshadapt::AdaptOptions adapt;
  int verbosity = 1;
  int threads = 0;
  bool racing = false;
  bool metric_found = false;  // beside the mesh
  bool with_metric = true;    // write the metric at the new vertices
  bool keep_sizes = false;    // whatever metric there is with the mesh
};

/// Throws UsageError, or InputError if outputs cannot be written. `output` replaces -o.
AdaptJob read_adapt_job(const Arguments& arguments,
                        const std::optional<std::filesystem::path>& output = {});

/// Sets the part that needs no files: options of adapt(), threads, verbosity, memory. Throws
/// UsageError.
void set_options_of_work(AdaptJob& job, const Arguments& arguments);

/// The metric that a job asks for, at the vertices of the input. Throws InputError.
meshadapt::AnyField choose_metric(const runtime::Executor& executor, const AdaptJob& job,
                                  const meshadapt::MeshWithFields& file,
                                  const meshadapt::Sizes& sizes, meshadapt::Warnings& warnings);

/// The source of that metric in words: "part.sol (found beside the mesh)".
std::string metric_said(const AdaptJob& job, const meshadapt::MeshWithFields& file);

/// The options about sizes that are in force.
std::vector<ValueInForce> values_in_force(const AdaptJob& job);

}  // namespace ductile::cli
