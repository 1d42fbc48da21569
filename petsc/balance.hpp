/// @file
/// Balance: elements are shared out so that each rank has about as much to do.
#pragma once

#include <cstdint>
#include <vector>

#include "bisection.hpp"
#include "communicator.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// How many elements each element is going to be, by the metric that is wanted; at least a tenth,
/// because elements that go are work, too. None of an empty part.
template <int Dim>
std::vector<double> predicted_elements(const Part& part);

/// The largest load of a rank over the mean. Collective.
double imbalance(const Communicator& comm, const std::vector<double>& load_of);

/// Throws InputError, on all ranks, if loads are more elements than ranks can count. Where sizes
/// are that small, a part of few elements has hardly a vertex that is not held, and would not see
/// it. Collective.
void expect_countable(const Communicator& comm, const std::vector<double>& load_of);

/// The rank to which each element goes so that loads are about equal, except for what planes are
/// displaced, and interfaces small; parts go to those ranks that have most of them. Every rank gets
/// elements, unless there are fewer than ranks. Collective.
template <int Dim>
std::vector<int> balanced(const Communicator& comm, const Part& part,
                          const std::vector<double>& load_of, Displaced displaced);

extern template std::vector<double> predicted_elements<2>(const Part&);
extern template std::vector<double> predicted_elements<3>(const Part&);
extern template std::vector<int> balanced<2>(const Communicator&, const Part&,
                                             const std::vector<double>&, Displaced);
extern template std::vector<int> balanced<3>(const Communicator&, const Part&,
                                             const std::vector<double>&, Displaced);

}  // namespace ductile::petsc
