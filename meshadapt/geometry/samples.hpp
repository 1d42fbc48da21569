/// @file
/// Samples: the vertices of the smooth patches, or curves, of a model, with its normals or tangents
/// there. Curvature is fitted to them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// `Corners` is 2 for edges, 3 for triangles. A point has a sample for each patch, or for each
/// chain of edges that passes through it or ends there.
template <int Dim, std::size_t Corners>
struct Samples {
  struct Sample {
    Vector<Dim> position;
    Vector<Dim> direction;  ///< unit normal of a triangle's patch, or tangent; to either side
    double area = 0;        ///< of the part of the patch that is closest; its length on a curve
  };
  using Facet = std::array<std::uint32_t, Corners>;

  std::vector<Sample> all;
  std::vector<Facet> facets;  ///< [facet or edge of the model], its samples, `none` if not smooth

  /// The facets at a sample, after connect().
  std::span<const std::uint32_t> facets_at(std::uint32_t sample) const {
    return std::span(facets_at_)
        .subspan(first_of_[sample], first_of_[sample + 1] - first_of_[sample]);
  }
  void connect();

  /// [sample], the width of the widest flat part beside it: of facets, connected by samples, that
  /// are within a distance of the plane, or line, of the largest. Thread safety: one caller; runs
  /// on the executor.
  std::vector<double> widths(const runtime::Executor& executor, double flat) const;

 private:
  std::array<Vector<Dim>, Corners> points(std::uint32_t facet) const;
  double area(std::uint32_t facet) const;
  void grow(std::uint32_t seed, double flat, std::vector<std::uint8_t>& seen,
            std::vector<std::uint32_t>& part) const;
  double width_of(std::span<const std::uint32_t> part) const;

  std::vector<std::uint32_t> first_of_, facets_at_;
};

extern template struct Samples<2, 2>;
extern template struct Samples<3, 2>;
extern template struct Samples<3, 3>;

}  // namespace ductile::meshadapt
