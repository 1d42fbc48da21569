/// @file
/// The level set of `ductile adapt`: -ls and the options that belong to it, with Mmg's meaning, and
/// the mesh of the input cut along it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/level_set.hpp"
#include "report.hpp"

namespace ductile::cli {

struct LevelSetOption {
  CutOptions cut;                     // without its materials, which are in a file
  std::optional<std::string> values;  // the value of -sol: a file, or a field of the mesh's file
};

/// -ls and its options; none without -ls. Throws UsageError.
std::optional<LevelSetOption> level_set_option(const Arguments& arguments);

/// The values at the vertices of the mesh: the one scalar field that the option names or, without a
/// name, that is in the mesh's own file. Throws InputError.
AnyField read_level_set(const LevelSetOption& option, const MeshWithFields& file,
                        Warnings& warnings);

/// A cut and what it was made from.
struct CutInput {
  AnyMesh before;
  CutReport report;
  std::string where;                      // "phi.sol is 0.5"
  std::vector<std::int32_t> minus, plus;  // references of the elements on each side
  std::int32_t interface = 0;             // of the facets on the surface
};

/// The report of a cut that was made with these options, which may have got materials since; the
/// mesh before is for the caller to set.
CutInput cut_report(const LevelSetOption& option, const CutOptions& options,
                    const CutReport& report);

/// The lines and the JSON object about a cut.
std::string to_text(const CutInput& cut);
Json to_json(const CutInput& cut);

}  // namespace ductile::cli
