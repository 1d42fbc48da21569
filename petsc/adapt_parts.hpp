/// @file
/// adapt_parts: adapts a mesh that is distributed over ranks. Each pass adapts all parts at once,
/// with the interfaces between them as they are and sizes that go over into theirs; then the
/// interfaces are displaced, so that what was held is adapted in the next pass. At the end elements
/// are shared out anew.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "adapt_part.hpp"
#include "communicator.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// What passes consist of.
enum class Phase : std::uint8_t { balance, migration, gradation, adaptation };
inline constexpr std::size_t phase_count = 4;

/// How the mesh stands after a pass; figures of all ranks.
struct PassReport {
  int pass = 0;  ///< from 1
  std::int64_t elements = 0;
  std::int64_t edges = 0;    ///< around shared vertices
  std::int64_t blocked = 0;  ///< of these, far from what is wanted (see EdgesAtInterfaces)
  double imbalance = 1;      ///< the largest number of elements of a rank over the mean
  double seconds = 0;        ///< of this pass, on the slowest rank
  /// [phase] Of all ranks together, since the last pass.
  std::array<Costs, phase_count> costs = {};
};

/// The required_gradation at interfaces: sizes go over into theirs within a few elements. With less
/// there are many elements of those sizes to be replaced in the next pass; without any limit, poor
/// ones along the interface are tried again and again, for nothing.
inline constexpr double gradation_at_interfaces = 60;

struct AdaptPartsOptions : AdaptPartOptions {
  int passes = 3;                                    ///< at most; at least one is made
  std::function<void(const PassReport&)> told = {};  ///< called after each pass, on all ranks
};

/// A distributed mesh that may be made something else of.
struct AdaptedParts {
  Part part;  ///< numbered in the order of the ranks; lists its boundary
  Interfaces interfaces;
  std::int64_t own = 0;  ///< vertices that this rank has numbered
  std::vector<PassReport> passes;
  std::array<Costs, phase_count> last = {};  ///< after the last pass
  meshadapt::Warnings warnings = {};         ///< of adapt() on all ranks, see warnings_of_ranks()
};

/// Adapts the part of each rank. On one rank the result is that of adapt(). The same number of
/// ranks gives the same result, whatever the number of threads. What goes wrong on one rank is
/// thrown on all, as Error. Collective.
template <int Dim>
AdaptedParts adapt_parts(const Communicator& comm, const runtime::Executor& executor, Part part,
                         const AdaptPartsOptions& options);

extern template AdaptedParts adapt_parts<2>(const Communicator&, const runtime::Executor&, Part,
                                            const AdaptPartsOptions&);
extern template AdaptedParts adapt_parts<3>(const Communicator&, const runtime::Executor&, Part,
                                            const AdaptPartsOptions&);

}  // namespace ductile::petsc
