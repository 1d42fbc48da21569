/// @file
/// Sizes by places on the command line: --near sphere:0,0,0,0.1:0.01:1.2, --on wall:0.01, --in
/// 3:0.05. Wrong words are refused before any file is read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/sizes.hpp"

namespace ductile::cli {

/// The parts of a text between the letters `at`.
std::vector<std::string> split(const std::string& text, char at);

/// The value of an option as a size for a metric. Throws UsageError.
std::optional<double> size_option(const Arguments& arguments, std::string_view name);

/// -hmin and -hmax; 0 without them. Throws UsageError.
SizeBounds size_bounds(const Arguments& arguments);

/// The factor of an option about growth; 0 for none, which 0 or less says, as in Mmg. Throws
/// UsageError.
double gradation_of(const Arguments& arguments, std::string_view option);

/// The value of --recovery: how second derivatives of a solution are found. Throws UsageError.
Recovery recovery_in(const Arguments& arguments);

/// The values of --near, --on, --in and --inside, and of an option for the size elsewhere. Names
/// and references are looked up when the mesh is known.
class SizeOptions {
 public:
  SizeOptions() = default;
  /// Throws UsageError.
  SizeOptions(const Arguments& arguments, std::string_view elsewhere);

  /// True if there are places.
  bool any() const { return !words_.empty(); }

  /// Files that places are read from.
  std::vector<fs::path> inputs() const;

  /// For this mesh, whose dimension says how many coordinates a point has. Reads the files of
  /// places. Throws UsageError where other numbers are needed, InputError for files.
  Sizes sizes_for(const AnyMesh& mesh, Warnings& warnings) const;

 private:
  struct Words {
    std::string all;    // the option and its value, for messages
    std::string shape;  // "sphere"; "on" and "in" for references and names
    std::string name;   // of a reference or a file
    std::vector<double> numbers;
    double size = 0;
    SizeGrowth growth;
  };
  static Words read(const std::string& option, const std::string& value);
  static SizePlace place_of(const Words& words, const AnyMesh& mesh, Warnings& warnings);

  double elsewhere_ = 0;
  std::vector<Words> words_;
};

}  // namespace ductile::cli
