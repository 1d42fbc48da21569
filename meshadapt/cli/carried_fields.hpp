/// @file
/// CarriedFields: the fields that `adapt` carries to the new mesh, each in its own file. All are
/// carried at once, because finding overlapping elements takes most of the time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::cli {

class CarriedFields {
 public:
  CarriedFields() = default;
  /// Throws UsageError if options do not go together, or two fields would go into one file.
  CarriedFields(const Arguments& arguments, const std::filesystem::path& output);

  bool interpolates() const { return interpolate_; }
  const std::vector<std::filesystem::path>& inputs() const { return inputs_; }
  /// OUT.FIELD.sol for each FIELD, in the folder of OUT; none if OUT itself holds fields.
  const std::vector<std::filesystem::path>& outputs() const { return outputs_; }

  struct Values {
    std::vector<meshadapt::NamedField> fields;  ///< at vertices, of one file after another
    std::vector<std::size_t> count_of;          ///< [file]
  };
  /// Reads the files. No two fields get the same name, and none is called metric. Throws InputError
  /// unless they are fields of this mesh.
  Values read(const meshadapt::AnyMesh& mesh, meshadapt::Warnings& warnings) const;

  /// The same fields at the vertices of the mesh `to`.
  std::vector<meshadapt::NamedField> carry(const runtime::Executor& executor,
                                           const meshadapt::AnyMesh& from, const Values& values,
                                           const meshadapt::AnyMesh& to) const;

  /// Writes the outputs; count_of is that of the values.
  void write(meshadapt::AtomicOutputs& outputs, const meshadapt::AnyMesh& mesh,
             const std::vector<meshadapt::NamedField>& carried,
             const std::vector<std::size_t>& count_of) const;

 private:
  std::vector<std::filesystem::path> inputs_, outputs_;  // [file]
  bool interpolate_ = false;
};

}  // namespace ductile::cli
