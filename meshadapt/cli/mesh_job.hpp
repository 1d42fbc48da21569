/// @file
/// MeshJob: the command lines of `adapt` and `move`, as far as they are the same: a mesh with a
/// metric and fields becomes another one.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/executor.hpp"
#include "report.hpp"

namespace ductile::cli {

/// The fields that are carried to the new mesh, each in its own file. All are carried at once,
/// because finding overlapping elements takes most of the time.
class CarriedFields {
 public:
  CarriedFields() = default;
  /// Throws UsageError if options do not go together, or two fields would go into one file.
  CarriedFields(const Arguments& arguments, const fs::path& output);

  bool interpolates() const { return interpolate_; }
  const std::vector<fs::path>& inputs() const { return inputs_; }
  /// OUT.FIELD.sol for each FIELD, in the folder of OUT; none if OUT itself holds fields.
  const std::vector<fs::path>& outputs() const { return outputs_; }

  struct Values {
    std::vector<NamedField> fields;     ///< at vertices, of one file after another
    std::vector<std::size_t> count_of;  ///< [file]
  };
  /// Reads the files. No two fields get the same name, and none is called metric. Throws InputError
  /// unless they are fields of this mesh.
  Values read(const AnyMesh& mesh, Warnings& warnings) const;

  /// The same fields at the vertices of the mesh `to`.
  std::vector<NamedField> carry(const runtime::Executor& executor, const AnyMesh& from,
                                const Values& values, const AnyMesh& to) const;

  /// Writes the outputs; count_of is that of the values.
  void write(AtomicOutputs& outputs, const AnyMesh& mesh, const std::vector<NamedField>& carried,
             const std::vector<std::size_t>& count_of) const;

 private:
  std::vector<fs::path> inputs_, outputs_;  // [file]
  bool interpolate_ = false;
};

struct MeshJob {
  fs::path input, output;
  std::optional<fs::path> metric_in, metric_out, json, vtu;
  std::optional<double> size;  // everywhere
  CarriedFields fields;
  bool with_metric = true;  // write the metric at the new vertices
  int verbosity = 1, threads = 0;
};

/// Sets all but the inputs; the mesh must be known. `output` replaces the value of -o. Throws
/// UsageError.
void set_job(MeshJob& job, const Arguments& arguments, const std::optional<fs::path>& output = {});

/// The files that the job writes; standard output by its name.
std::vector<fs::path> outputs_of(const MeshJob& job);
/// "written: a.o.mesh, a.o.sol".
std::string written(const MeshJob& job);
/// Standard output, or standard error if the mesh or JSON goes to the former. Takes no memory.
std::FILE* messages_of(const MeshJob& job);

/// The new mesh and the data on it.
struct MeshOutput {
  const AnyMesh& mesh;
  const AnyField& metric;
  const std::vector<NamedField>& fields;
  const std::vector<std::size_t>& field_count_of;  // [file that CarriedFields writes]
  std::function<Json()> json;                      // called when the warnings are known
};

/// Writes all outputs of a job, or none. Prints the warnings before.
void write_outputs(const MeshJob& job, const MeshOutput& output, Warnings& warnings);

}  // namespace ductile::cli
