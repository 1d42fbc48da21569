/// @file
/// The sides of the zero of a linear interpolant: their volumes, and small connected parts of them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// Volume of the split elements in which the linear interpolant is below a level. Thread safety of
/// this and the following: one caller; runs on the executor.
template <int Dim>
double volume_below(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                    std::span<const double> value_of, double level);

/// Makes values of 0 positive. Where nothing but zeros is connected to them and they have many
/// facets on the border of a material, the surface lies on the border: there they become negative.
template <int Dim>
void count_zeros(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                 std::vector<double>& value_of);

struct RemovedComponents {
  std::size_t count = 0;
  double volume = 0;
};

/// Changes the sign of the values in connected parts of either side that have less than a fraction
/// of the volume of the mesh: first where values are positive, then where they are negative.
template <int Dim>
RemovedComponents remove_small_components(const runtime::Executor& executor,
                                          const CutDomain<Dim>& domain,
                                          std::vector<double>& value_of, double least_fraction);

extern template double volume_below(const runtime::Executor&, const CutDomain<2>&,
                                    std::span<const double>, double);
extern template double volume_below(const runtime::Executor&, const CutDomain<3>&,
                                    std::span<const double>, double);
extern template void count_zeros(const runtime::Executor&, const CutDomain<2>&,
                                 std::vector<double>&);
extern template void count_zeros(const runtime::Executor&, const CutDomain<3>&,
                                 std::vector<double>&);
extern template RemovedComponents remove_small_components(const runtime::Executor&,
                                                          const CutDomain<2>&, std::vector<double>&,
                                                          double);
extern template RemovedComponents remove_small_components(const runtime::Executor&,
                                                          const CutDomain<3>&, std::vector<double>&,
                                                          double);

}  // namespace ductile::meshadapt
