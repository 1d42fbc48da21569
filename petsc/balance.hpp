/// @file
/// Balance: elements are shared out so that each rank has about as much to do, by PT-Scotch on the
/// graph of elements that share a facet. It runs in a context of its own, which makes it
/// deterministic.
#pragma once

#include <cstdint>
#include <vector>

#include "communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// How many elements each element is going to be, by the metric that is wanted; at least a tenth,
/// because elements that go are work, too. None of an empty part. Throws InputError if the part is
/// not a valid mesh.
template <int Dim>
std::vector<double> predicted_elements(const runtime::Executor& executor, const Part& part);

/// The largest load of a rank over the mean. Collective.
double imbalance(const Communicator& comm, const std::vector<double>& load_of);

/// The rank to which each element goes so that loads are about equal and interfaces small; parts go
/// to those ranks that have most of them. Every rank gets elements, unless there are fewer than
/// ranks. The part lists its boundary. Throws Error, on all ranks, if PT-Scotch fails. Collective.
template <int Dim>
std::vector<int> balanced(const Communicator& comm, const Part& part, const Interfaces& interfaces,
                          const std::vector<double>& load_of);

extern template std::vector<double> predicted_elements<2>(const runtime::Executor&, const Part&);
extern template std::vector<double> predicted_elements<3>(const runtime::Executor&, const Part&);
extern template std::vector<int> balanced<2>(const Communicator&, const Part&, const Interfaces&,
                                             const std::vector<double>&);
extern template std::vector<int> balanced<3>(const Communicator&, const Part&, const Interfaces&,
                                             const std::vector<double>&);

}  // namespace ductile::petsc
