#include "metric.hpp"

#include <algorithm>
#include <vector>

#include "distributed/adapt_part.hpp"
#include "distributed/interfaces.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace ductile::petsc {

using meshadapt::InputError;
using meshadapt::Metric;

namespace {

/// Layout of a vector with one value or tensor for each vertex of the DMPlex.
struct Layout {
  PetscInt each;  ///< components of a vertex
  bool same_for_all;

  PetscInt begin(PetscInt vertex) const { return same_for_all ? 0 : vertex * each; }
};

Layout layout_of(DM dm, PetscInt dimension) {
  PetscBool isotropic = PETSC_FALSE, uniform = PETSC_FALSE;
  check(DMPlexMetricIsIsotropic(dm, &isotropic));
  check(DMPlexMetricIsUniform(dm, &uniform));
  const bool one = isotropic == PETSC_TRUE || uniform == PETSC_TRUE;
  return {one ? 1 : dimension * dimension, uniform == PETSC_TRUE};
}

/// Symmetric tensors from upper triangles, or from a value times the unit tensor.
AnyField tensors(const PetscScalar* values, const Layout& layout, const PlexPart& part) {
  const int dimension = part.part.mesh.dimension;
  AnyField field{dimension, part.point_of.size(), {AnyField::Type::symmetric}, {}, "metric"};
  for (const PetscInt vertex : part.point_of) {
    const PetscScalar* const at = values + layout.begin(vertex);
    for (int j = 0; j < dimension; ++j)
      for (int i = 0; i <= j; ++i)
        field.values.push_back(layout.each > 1 ? PetscRealPart(at[i * dimension + j])
                               : i == j        ? PetscRealPart(at[0])
                                               : 0);
  }
  return field;
}

std::int32_t flag_at(DMLabel label, PetscInt cell) {
  PetscInt value = 0;
  check(DMLabelGetValue(label, cell, &value));
  return static_cast<std::int32_t>(value);
}

/// [vertex] Factor for its sizes.
template <int Dim>
std::vector<double> factors(const Part& part, const std::vector<std::int32_t>& flag_of) {
  std::vector<double> factor_of(part.mesh.vertex_count(), 1);
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh).vertices;
  for (const std::int32_t flag : {DM_ADAPT_COARSEN, DM_ADAPT_REFINE})
    for (std::size_t e = 0; e < elements.size(); ++e)
      if (flag_of[e] == flag)
        for (const VertexId v : elements[e]) factor_of[v] = flag == DM_ADAPT_REFINE ? 0.5 : 2;
  return factor_of;
}

/// Averages logarithms, and takes the least factor, over all ranks at shared vertices.
template <int Dim>
AnyField agreed(const Communicator& comm, const runtime::Executor& executor, const Part& part,
                const AnyField& sizes, std::vector<double> factor_of) {
  struct AtVertex {
    Metric<Dim> logarithm;
    double factor, count;
  };
  Part listed = part;
  std::vector<Metric<Dim>> tensor_of;
  comm.on_all([&] {
    list_boundary(executor, listed);
    if (part.element_count() > 0) tensor_of = meshadapt::tensors_of<Dim>(executor, sizes);
  });
  const Interfaces interfaces = find_interfaces(comm, listed);
  std::vector<AtVertex> own;
  for (const SharedVertex& shared : interfaces.vertices)
    own.push_back({meshadapt::logarithm(tensor_of[shared.vertex]), factor_of[shared.vertex], 1});
  // Summed in the order of ranks, so that all get the same result.
  std::vector<AtVertex> sum_of(own.size(), {{}, 2, 0});
  visit_at_vertices(comm, interfaces, own, [&](std::size_t i, int, const AtVertex* one) {
    AtVertex& sum = sum_of[i];
    sum = {sum.logarithm + one->logarithm, std::min(sum.factor, one->factor), sum.count + 1};
  });
  for (std::size_t i = 0; i < sum_of.size(); ++i) {
    const AtVertex& sum = sum_of[i];
    const VertexId v = interfaces.vertices[i].vertex;
    tensor_of[v] = meshadapt::exponential((1 / sum.count) * sum.logarithm);
    factor_of[v] = sum.factor;
  }
  for (std::size_t v = 0; v < tensor_of.size(); ++v)
    tensor_of[v] *= 1 / (factor_of[v] * factor_of[v]);
  return meshadapt::symmetric_field(executor, tensor_of, "metric");
}

template <int Dim>
AnyField metric_of_flags(const Communicator& comm, const runtime::Executor& executor,
                         const Part& part, const std::vector<std::int32_t>& flag_of) {
  const AnyField sizes = comm.on_all([&] {
    return part.element_count() == 0 ? part.wanted : meshadapt::default_metric(executor, part.mesh);
  });
  return agreed<Dim>(comm, executor, part, sizes,
                     comm.on_all([&] { return factors<Dim>(part, flag_of); }));
}

}  // namespace

AnyField metric_of_vector(const Communicator& comm, DM dm, Vec vector, const PlexPart& part,
                          const meshadapt::SizeBounds& bounds) {
  const Layout layout = layout_of(dm, part.part.mesh.dimension);
  return comm.on_all([&] {
    PetscInt length = 0;
    check(VecGetLocalSize(vector, &length));
    const PetscInt vertices = vertices_of(dm).size();
    const PetscInt expected = layout.same_for_all ? layout.each : layout.each * vertices;
    if (length < expected)
      throw InputError("metric: expected a local vector of " + std::to_string(expected) +
                       " values, " + std::to_string(layout.each) + " for each of " +
                       (layout.same_for_all ? "all" : std::to_string(vertices)) +
                       " vertices, found " + std::to_string(length));
    const PetscScalar* values = nullptr;
    check(VecGetArrayRead(vector, &values));
    const AnyField field = tensors(values, layout, part);
    check(VecRestoreArrayRead(vector, &values));
    if (part.part.mesh.vertex_count() == 0) return part.part.wanted;
    return meshadapt::metric_of(field, part.part.mesh, bounds);
  });
}

AnyField metric_of_label(const Communicator& comm, const runtime::Executor& executor, DMLabel label,
                         const PlexPart& part) {
  const std::vector<std::int32_t> flag_of = comm.on_all([&] {
    std::vector<std::int32_t> flags;
    for (const PetscInt cell : part.cell_of) flags.push_back(flag_at(label, cell));
    return flags;
  });
  return part.part.mesh.dimension == 2 ? metric_of_flags<2>(comm, executor, part.part, flag_of)
                                       : metric_of_flags<3>(comm, executor, part.part, flag_of);
}

}  // namespace ductile::petsc
