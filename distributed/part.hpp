/// @file
/// Part: the part of a distributed mesh on one rank. Each element is in one part; vertices on
/// interfaces are in several, with the same number in each.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::distributed {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::VertexId;

/// The reference of entities without a label.
inline constexpr std::int32_t unlabelled = std::numeric_limits<std::int32_t>::min();

struct Part {
  /// References are values of labels. Facets, and edges of tetrahedra, are listed if they have one;
  /// those on interfaces in all parts that have them.
  AnyMesh mesh;
  AnyField wanted;                      ///< the target metric, one symmetric tensor per vertex
  std::vector<std::int64_t> number_of;  ///< [vertex], the same on all ranks
  std::vector<std::uint8_t> is_held;    ///< [vertex], 1 if the last pass held it

  std::size_t element_count() const {
    return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  }
};

/// The target metric at a vertex.
template <int Dim>
meshadapt::Metric<Dim> wanted_at(const Part& part, VertexId v) {
  meshadapt::Metric<Dim> metric;
  std::copy_n(&part.wanted.values[std::size_t{v} * metric.m.size()], metric.m.size(),
              metric.m.begin());
  return metric;
}

/// The vertices of a part, sorted by their numbers.
inline std::vector<VertexId> by_number(const Part& part) {
  std::vector<VertexId> order(part.number_of.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::sort(order.begin(), order.end(),
            [&](VertexId a, VertexId b) { return part.number_of[a] < part.number_of[b]; });
  return order;
}

/// An empty part, for a rank without elements.
inline Part empty_part(int dimension) {
  Part part;
  part.mesh.dimension = part.wanted.dimension = dimension;
  part.wanted.types = {AnyField::Type::symmetric};
  return part;
}

}  // namespace ductile::distributed
