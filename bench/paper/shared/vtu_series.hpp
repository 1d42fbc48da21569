/// @file
/// VtuSeries: meshes and fields at several times for ParaView: NAME/NAME_0000.vtu, ... and
/// NAME.pvd, which names them all with their times and is the file to open.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"

namespace ductile::paper {

class VtuSeries {
 public:
  /// `index` is the path of NAME.pvd; makes the folder beside it.
  explicit VtuSeries(std::filesystem::path index);

  /// Writes a file and rewrites the index, so that a run can be viewed while it goes on.
  void add(double time, const meshadapt::AnyMesh& mesh,
           const std::vector<meshadapt::NamedField>& fields);

 private:
  void write_index() const;

  std::filesystem::path index_;
  std::vector<double> times_;
};

}  // namespace ductile::paper
