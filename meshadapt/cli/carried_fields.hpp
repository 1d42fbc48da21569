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

  const std::vector<std::filesystem::path>& inputs() const { return inputs_; }
  /// OUT.FIELD.sol for each FIELD, in the folder of OUT; none if OUT itself holds fields.
  const std::vector<std::filesystem::path>& outputs() const { return outputs_; }

  struct Values {
    meshadapt::AnyField all;                  ///< the fields in all files, side by side
    std::vector<std::size_t> field_count_of;  ///< [file]
    std::vector<std::string> names;           ///< [field]
  };
  /// Throws InputError unless they are fields of this mesh. `taken` are names that other fields
  /// have.
  Values read(const meshadapt::AnyMesh& mesh, meshadapt::Warnings& warnings,
              std::vector<std::string> taken) const;

  /// A field for each file, at the vertices of the mesh `to`.
  std::vector<meshadapt::AnyField> carry(const runtime::Executor& executor,
                                         const meshadapt::AnyMesh& from, const Values& values,
                                         const meshadapt::AnyMesh& to) const;

  void write(meshadapt::AtomicOutputs& outputs,
             const std::vector<meshadapt::AnyField>& carried) const;
  static std::vector<meshadapt::NamedField> named_fields(
      const std::vector<meshadapt::AnyField>& carried, const std::vector<std::string>& names);

 private:
  std::vector<std::filesystem::path> inputs_, outputs_;  // [file]
  bool interpolate_ = false;
};

}  // namespace ductile::cli
