#include "distributed/adapt_part.hpp"

#include <algorithm>
#include <utility>

#include "distributed/listed.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::distributed {

using meshadapt::Metric;
using runtime::Executor;

namespace {

/// Adds the indices of entities that have one of these references.
void add_with(std::vector<std::uint32_t>& indices, const std::vector<std::int32_t>& reference_of,
              const std::vector<std::int32_t>& references) {
  if (references.empty()) return;
  for (std::uint32_t i = 0; i < reference_of.size(); ++i)
    if (std::binary_search(references.begin(), references.end(), reference_of[i]))
      indices.push_back(i);
}

/// Requires entities that must stay, and marks vertices among them by references: their index plus
/// 1.
template <int Dim>
AnyMesh with_required(const Part& part, const Interfaces& interfaces,
                      const AdaptPartOptions& options) {
  AnyMesh mesh = part.mesh;
  const auto require = [&](VertexId v) {
    if (mesh.vertex_reference[v] != 0) return;
    mesh.vertex_reference[v] = static_cast<std::int32_t>(v) + 1;
    mesh.required_vertices.push_back(v);
  };
  std::fill(mesh.vertex_reference.begin(), mesh.vertex_reference.end(), 0);
  for (const SharedVertex& shared : interfaces.vertices) require(shared.vertex);
  for (VertexId v = 0; v < mesh.vertex_count(); ++v)
    if (part.mesh.vertex_reference[v] != unlabelled) require(v);
  auto& required = Dim == 2 ? mesh.required_edges : mesh.required_triangles;
  for (const SharedFacet& shared : interfaces.facets) required.push_back(shared.facet);
  add_with(required, meshadapt::facets_in<Dim>(mesh).reference, options.required_facets);
  add_with(Dim == 2 ? mesh.required_triangles : mesh.required_tetrahedra,
           meshadapt::elements_in<Dim>(mesh).reference, options.required_elements);
  return mesh;
}

template <int Dim>
AnyField mapped(const Executor& executor, const AnyField& field,
                Metric<Dim> (*map)(const Metric<Dim>&)) {
  auto tensor_of = meshadapt::tensors_of<Dim>(executor, field);
  runtime::parallel_for(executor, tensor_of.size(),
                        [&](std::size_t v) { tensor_of[v] = map(tensor_of[v]); });
  return meshadapt::symmetric_field(executor, tensor_of, field.name);
}

/// Interpolates the target metric to the vertices of another mesh of the same part.
template <int Dim>
AnyField wanted_on(const Executor& executor, const Part& part, const AnyMesh& mesh) {
  const AnyField logarithms = mapped<Dim>(executor, part.wanted, meshadapt::logarithm<Dim>);
  const auto carried = meshadapt::interpolate_field(executor, {part.mesh, logarithms}, mesh);
  return mapped<Dim>(executor, carried.field, meshadapt::exponential<Dim>);
}

/// The target metric, and then those of another source, if there is one.
class TargetFirst : public meshadapt::MetricSource {
 public:
  TargetFirst(const AnyField& target, MetricSource* others) : target_(target), others_(others) {}
  const AnyField* next(const meshadapt::AdaptState& state) override {
    if (state.pass == 0) return &target_;
    return others_ == nullptr ? nullptr : others_->next(state);
  }

 private:
  const AnyField& target_;
  MetricSource* others_;
};

/// Restores the numbers and labels of marked vertices; the others get none.
void restore_vertices(const Part& before, Part& after, Interfaces& interfaces) {
  std::vector<VertexId> now(before.mesh.vertex_count(), meshadapt::none);
  after.number_of.assign(after.mesh.vertex_count(), -1);
  for (VertexId v = 0; v < after.mesh.vertex_count(); ++v) {
    std::int32_t& reference = after.mesh.vertex_reference[v];
    if (reference != 0) {
      const auto was = static_cast<VertexId>(reference - 1);
      now[was] = v;
      after.number_of[v] = before.number_of[was];
      reference = before.mesh.vertex_reference[was];
    } else {
      reference = unlabelled;
    }
  }
  for (SharedVertex& shared : interfaces.vertices) shared.vertex = now[shared.vertex];
}

template <int Dim>
AdaptedPart adapt_part(const Executor& executor, Part part, const Interfaces& interfaces,
                       const AdaptPartOptions& options) {
  AdaptedPart result{{}, interfaces, {}};
  if (part.element_count() == 0) {
    result.part = std::move(part);
    return result;
  }
  TargetFirst source(part.wanted, options.source);
  auto [mesh, metric, report] = meshadapt::adapt(
      executor, with_required<Dim>(part, interfaces, options), source, options.adapt);
  result.report = std::move(report);
  result.part.mesh = std::move(mesh);
  AnyMesh& after = result.part.mesh;
  after.corners.clear();
  after.required_vertices.clear();
  if (Dim == 2) after.required_edges.clear();
  after.required_triangles.clear();
  after.required_tetrahedra.clear();
  restore_vertices(part, result.part, result.interfaces);
  drop_unlabelled<Dim>(after);
  result.part.wanted =
      interfaces.vertices.empty() ? std::move(metric) : wanted_on<Dim>(executor, part, after);
  return result;
}

}  // namespace

void list_boundary(const Executor& executor, Part& part) {
  if (part.element_count() == 0) return;
  auto& references =
      part.mesh.dimension == 2 ? part.mesh.edges.reference : part.mesh.triangles.reference;
  const std::size_t labelled = references.size();
  meshadapt::list_boundary(executor, part.mesh);
  std::fill(references.begin() + static_cast<std::ptrdiff_t>(labelled), references.end(),
            unlabelled);
}

AdaptedPart adapt_part(const Executor& executor, Part part, const Interfaces& interfaces,
                       const AdaptPartOptions& options) {
  return part.mesh.dimension == 2 ? adapt_part<2>(executor, std::move(part), interfaces, options)
                                  : adapt_part<3>(executor, std::move(part), interfaces, options);
}

AnyField bound_at_curves(const Executor& executor, const Part& part, const Interfaces& interfaces,
                         const AdaptPartOptions& options) {
  if (part.element_count() == 0) return part.wanted;
  const AnyMesh mesh = part.mesh.dimension == 2 ? with_required<2>(part, interfaces, options)
                                                : with_required<3>(part, interfaces, options);
  return meshadapt::bound_at_curved_boundaries(executor, mesh, part.wanted, options.adapt);
}

}  // namespace ductile::distributed
