/// @file
/// adapt_parts: adapts a mesh distributed over ranks. Each pass adapts all parts at once, keeping
/// the interfaces between them and blending sizes into theirs; then the interfaces are displaced,
/// so that the next pass adapts what was held. At the end elements are redistributed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "distributed/adapt_part.hpp"
#include "distributed/communicator.hpp"
#include "distributed/interfaces.hpp"
#include "distributed/part.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// State of the mesh after a pass; figures over all ranks.
struct PassReport {
  int pass = 0;  ///< from 1
  std::int64_t elements = 0;
  std::int64_t edges = 0;    ///< around shared vertices
  std::int64_t blocked = 0;  ///< of these, far from the target length (see EdgesAtInterfaces)
  double imbalance = 1;      ///< largest number of elements of a rank divided by the mean
  double seconds = 0;        ///< of this pass, on the slowest rank
};

/// A line about a pass.
std::string to_text(const PassReport& pass);

/// The required_gradation at interfaces: sizes blend into theirs within a few elements. A smaller
/// value leaves many elements of those sizes to be replaced in the next pass; without a limit,
/// kernels try in vain to improve poor elements along the interface.
inline constexpr double gradation_at_interfaces = 60;

struct AdaptPartsOptions : AdaptPartOptions {
  int passes = 3;                                    ///< at most; at least one
  std::function<void(const PassReport&)> told = {};  ///< called after each pass, on all ranks
};

/// An adapted mesh, distributed.
struct AdaptedParts {
  Part part;  ///< numbered in the order of the ranks; lists its boundary
  Interfaces interfaces;
  std::int64_t own = 0;               ///< number of vertices that this rank has numbered
  meshadapt::Warnings warnings = {};  ///< of adapt() on all ranks, see warnings_of_ranks()
};

/// Adapts the part of each rank. On one rank the result is that of adapt(). It depends on the
/// number of ranks, not of threads. A failure on one rank is thrown on all, as Error. Collective.
AdaptedParts adapt_parts(const Communicator& comm, const runtime::Executor& executor, Part part,
                         const AdaptPartsOptions& options);

}  // namespace ductile::distributed
