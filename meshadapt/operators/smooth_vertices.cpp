#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/smooth.hpp"

namespace ductile::meshadapt {

namespace {

/// The marked vertices that may move, in order.
template <int Dim, int Space>
runtime::UnsetVector<VertexId> movable_of(const runtime::Executor& executor,
                                          const Mesh<Dim, Space>& mesh,
                                          const runtime::UnsetVector<std::uint8_t>& marked) {
  const auto find = [&](std::size_t v, auto&& append) {
    if (marked[v] != 0 && mesh.kind_of[v].class_dimension != 0) append(static_cast<VertexId>(v));
  };
  return runtime::parallel_collect<VertexId>(executor, marked.size(), find,
                                             runtime::few_nanoseconds.serial_below);
}

}  // namespace

template <int Dim, int Space>
runtime::UnsetVector<VertexId> Smooth<Dim, Space>::movable_vertices(
    const runtime::Executor& executor, const Mesh<Dim, Space>& mesh, std::uint32_t after) {
  return movable_of(executor, mesh, mark_changed(executor, mesh, after));
}

template <int Dim, int Space>
runtime::UnsetVector<VertexId> Smooth<Dim, Space>::movable_vertices_of_poor(
    const runtime::Executor& executor, const Mesh<Dim, Space>& mesh, double mean_ratio,
    std::uint32_t after) {
  const double bound = quality_of_mean_ratio<Dim>(mean_ratio);
  auto marked = runtime::make_filled<std::uint8_t>(executor, mesh.vertex_slots());
  runtime::parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    if (mesh.quality_of[e] >= bound || mesh.changed_at[e] <= after) return;
    if (!mesh.alive(static_cast<ElementId>(e))) return;
    for (const VertexId v : mesh.corners_of[e]) runtime::atomic_set(marked[v]);
  });
  return movable_of(executor, mesh, marked);
}

template <int Dim, int Space>
runtime::UnsetVector<VertexId> Smooth<Dim, Space>::vertices_on_surface(
    const runtime::Executor& executor, const Mesh<Dim, Space>& mesh, std::uint32_t after) {
  const auto marked = mark_changed(executor, mesh, after);
  const auto find = [&](std::size_t v, auto&& append) {
    const auto vertex = static_cast<VertexId>(v);
    if (marked[v] != 0 && (on_smooth_patch(mesh, vertex) || on_smooth_curve(mesh, vertex) ||
                           (mesh.vertex_alive(vertex) && in_smooth_patch(mesh, vertex))))
      append(vertex);
  };
  return runtime::parallel_collect<VertexId>(executor, marked.size(), find,
                                             runtime::few_nanoseconds.serial_below);
}

template runtime::UnsetVector<VertexId> Smooth<2>::movable_vertices(const runtime::Executor&,
                                                                    const Mesh<2>&, std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<2>::movable_vertices_of_poor(
    const runtime::Executor&, const Mesh<2>&, double, std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<2>::vertices_on_surface(const runtime::Executor&,
                                                                       const Mesh<2>&,
                                                                       std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<2, 3>::movable_vertices(const runtime::Executor&,
                                                                       const Mesh<2, 3>&,
                                                                       std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<2, 3>::movable_vertices_of_poor(
    const runtime::Executor&, const Mesh<2, 3>&, double, std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<2, 3>::vertices_on_surface(const runtime::Executor&,
                                                                          const Mesh<2, 3>&,
                                                                          std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<3>::movable_vertices(const runtime::Executor&,
                                                                    const Mesh<3>&, std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<3>::movable_vertices_of_poor(
    const runtime::Executor&, const Mesh<3>&, double, std::uint32_t);
template runtime::UnsetVector<VertexId> Smooth<3>::vertices_on_surface(const runtime::Executor&,
                                                                       const Mesh<3>&,
                                                                       std::uint32_t);

}  // namespace ductile::meshadapt
