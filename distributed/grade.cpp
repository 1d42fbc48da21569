#include "distributed/grade.hpp"

#include <optional>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"

namespace ductile::distributed {

using meshadapt::Metric;

namespace {

/// Intersects the metrics at shared vertices. Returns the number of refined ones over all ranks.
template <int Dim>
std::int64_t take_finer(const Communicator& comm, const Interfaces& interfaces,
                        std::vector<Metric<Dim>>& metric_of) {
  constexpr double tolerance = 1e-3;  // relative, for determinants
  std::vector<Metric<Dim>> at_shared;
  for (const SharedVertex& shared : interfaces.vertices)
    at_shared.push_back(metric_of[shared.vertex]);
  std::int64_t finer = 0;
  visit_at_vertices(comm, interfaces, at_shared,
                    [&](std::size_t i, int rank, const Metric<Dim>* other) {
                      if (rank == comm.rank()) return;
                      Metric<Dim>& metric = metric_of[interfaces.vertices[i].vertex];
                      const Metric<Dim> both = meshadapt::intersect(metric, *other);
                      finer += determinant(both) > (1 + tolerance) * determinant(metric) ? 1 : 0;
                      metric = both;
                    });
  return comm.sum(finer);
}

template <int Dim>
void grade(const Communicator& comm, const runtime::Executor& executor, Part& part,
           const Interfaces& interfaces, double factor) {
  constexpr int most_times = 50;  // growth from one part crosses few others
  std::optional<meshadapt::FixedMesh<Dim>> mesh;
  std::vector<Metric<Dim>> metric_of;
  comm.on_all([&] {
    if (part.element_count() == 0) return;
    mesh.emplace(meshadapt::make_fixed_mesh<Dim>(executor, part.mesh));
    metric_of = meshadapt::tensors_of<Dim>(executor, part.wanted);
  });
  for (int time = 0; time < most_times; ++time) {
    comm.on_all([&] {
      if (mesh && factor > 0)
        meshadapt::limit_gradation(executor, metric_of, *mesh, {.factor = factor});
    });
    if (take_finer(comm, interfaces, metric_of) == 0) break;
  }
  comm.on_all([&] {
    if (mesh) part.wanted = meshadapt::symmetric_field(executor, metric_of, part.wanted.name);
  });
}

}  // namespace

void grade(const Communicator& comm, const runtime::Executor& executor, Part& part,
           const Interfaces& interfaces, double factor) {
  part.mesh.dimension == 2 ? grade<2>(comm, executor, part, interfaces, factor)
                           : grade<3>(comm, executor, part, interfaces, factor);
}

}  // namespace ductile::distributed
