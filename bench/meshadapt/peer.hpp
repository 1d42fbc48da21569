/// @file
/// Peer: runs Mmg on the same files as the program ductile, alternating, on one thread. Both are
/// measured as whole processes, including files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cases/adapt_case.hpp"
#include "child.hpp"
#include "sample.hpp"

namespace ductile::bench {

/// One program's run on a case. Its mesh is judged in the start mesh's metric, interpolated.
struct ProgramRun {
  ChildReport child;
  std::size_t elements = 0;
  MeshFigures figures;
};

struct Pair {
  std::string case_name;
  ProgramRun ductile{}, mmg{};
};

struct PairSettings {
  std::filesystem::path folder;  ///< folder for the files
  int most_pairs = 3;
  double seconds = 60;  ///< no further pair begins after this time
};

/// Mmg for this dimension (mmg2d_O3, mmg3d_O3), if it is on the PATH.
std::optional<std::filesystem::path> find_mmg(int dimension);

/// Runs both programs in alternating order. If a program fails, the pair has its exit status.
std::vector<Pair> run_pairs(const AdaptCase& adapt_case, const std::filesystem::path& mmg,
                            const PairSettings& settings);

}  // namespace ductile::bench
