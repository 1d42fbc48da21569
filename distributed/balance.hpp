/// @file
/// Load balance: distributes elements so that each rank has about equal work.
#pragma once

#include <vector>

#include "distributed/bisection.hpp"
#include "distributed/communicator.hpp"
#include "distributed/part.hpp"

namespace ductile::distributed {

/// Predicted number of elements in place of each element, by the target metric; at least a tenth,
/// because removing elements is work too. Empty for an empty part.
std::vector<double> predicted_elements(const Part& part);

/// Largest load of a rank divided by the mean. Collective.
double imbalance(const Communicator& comm, const std::vector<double>& load_of);

/// Throws InputError, on all ranks, if the loads predict more elements than ranks can number. With
/// such small sizes, most vertices of small parts are held, so the parts would not notice.
/// Collective.
void expect_countable(const Communicator& comm, const std::vector<double>& load_of);

/// The rank for each element: loads are about equal, apart from the displacement of planes, and
/// interfaces are small; parts go to the ranks that hold most of them. Every rank gets elements
/// unless there are fewer than ranks. Collective.
std::vector<int> balanced(const Communicator& comm, const Part& part,
                          const std::vector<double>& load_of, Displaced displaced);

}  // namespace ductile::distributed
