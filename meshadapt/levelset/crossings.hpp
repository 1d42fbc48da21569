/// @file
/// Crossings: the edges whose ends lie on different sides of the surface, and where on them the
/// function is 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// An edge that the surface crosses at (1 - t) a + t b; a < b.
struct Crossing {
  VertexId a, b;
  double t;
  double squared_length;

  /// Edges are divided in this order, in each element, facet and listed edge by itself: the longest
  /// first.
  bool comes_before(const Crossing& other) const {
    if (squared_length != other.squared_length) return squared_length > other.squared_length;
    return a != other.a ? a < other.a : b < other.b;
  }
};

/// The edges of split elements whose ends have values of different sign, sorted by their vertices.
/// `function_of` has the values to recover gradients from; if it is empty, the function is linear
/// along edges. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<Crossing> find_crossings(const runtime::Executor& executor,
                                     const CutDomain<Dim>& domain, std::span<const double> value_of,
                                     std::span<const double> function_of);

extern template std::vector<Crossing> find_crossings(const runtime::Executor&, const CutDomain<2>&,
                                                     std::span<const double>,
                                                     std::span<const double>);
extern template std::vector<Crossing> find_crossings(const runtime::Executor&, const CutDomain<3>&,
                                                     std::span<const double>,
                                                     std::span<const double>);

}  // namespace ductile::meshadapt
