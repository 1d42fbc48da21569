#include "fingering/pressure.hpp"

#include "ductile/meshadapt/error.hpp"

namespace ductile::paper {

using meshadapt::ElementId;
using Point = meshadapt::Vector<2>;

PressureSolver::PressureSolver(const DualMesh& dual)
    : dual_(dual), unknown_of_(dual.vertex_count(), 0) {
  for (const VertexId v : dual.outlet) unknown_of_[v] = -1;
  for (int& unknown : unknown_of_)
    if (unknown == 0) unknown = unknown_count_++;
  factors_.analyzePattern(assemble(std::vector<double>(dual.mesh.element_count(), 1)));
}

PressureSolver::Matrix PressureSolver::assemble(const std::vector<double>& mobility_of) const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * dual_.mesh.element_count());
  for (ElementId e = 0; e < dual_.mesh.element_count(); ++e) {
    const auto gradients = meshadapt::hat_gradients<2>(dual_.mesh.points(e));
    const auto& corners = dual_.mesh.corners_of[e];
    const double weight = mobility_of[e] * dual_.mesh.volume_of[e];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const int row = unknown_of_[corners[i]], column = unknown_of_[corners[j]];
        // CHOLMOD reads the lower triangle only.
        if (column < 0 || row < column) continue;
        entries.emplace_back(row, column, weight * dot(gradients[i], gradients[j]));
      }
  }
  Matrix matrix(unknown_count_, unknown_count_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void PressureSolver::add_velocity(Flow& flow, const std::vector<double>& mobility_of) const {
  flow.flux_of.assign(dual_.edges.size(), 0);
  for (ElementId e = 0; e < dual_.mesh.element_count(); ++e) {
    const auto& corners = dual_.mesh.corners_of[e];
    const auto points = dual_.mesh.points(e);
    const auto gradients = meshadapt::hat_gradients<2>(points);
    Point velocity;
    for (std::size_t i = 0; i < 3; ++i)
      velocity -= mobility_of[e] * flow.pressure_of[corners[i]] * gradients[i];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
      // From the middle of the edge to the centre of the triangle; the face's normal is to the
      // right of it, as the next corner is.
      const Point half = (1.0 / 3) * (points[last] - 0.5 * (points[i] + points[next]));
      const double flux = velocity[0] * half[1] - velocity[1] * half[0];
      const EdgeId edge = dual_.edges_of[e][i];
      flow.flux_of[edge] += outflow_sign(dual_.edges[edge], corners[i]) * flux;
    }
  }
  for (const VertexId v : dual_.outlet) {
    double inflow = dual_.inflow_of[v];
    for (const EdgeId e : dual_.edges_at(v))
      inflow -= outflow_sign(dual_.edges[e], v) * flow.flux_of[e];
    flow.outflow_of.push_back(inflow);
  }
}

Flow PressureSolver::solve(const Fluids& fluids, const std::vector<double>& saturation_of) {
  std::vector<double> mobility_of(dual_.mesh.element_count(), 0);
  for (ElementId e = 0; e < mobility_of.size(); ++e)
    for (const VertexId v : dual_.mesh.corners_of[e])
      mobility_of[e] += mobility(fluids, saturation_of[v]) / 3;
  Eigen::VectorXd right(unknown_count_);
  for (VertexId v = 0; v < dual_.vertex_count(); ++v)
    if (unknown_of_[v] >= 0) right[unknown_of_[v]] = dual_.inflow_of[v];
  factors_.factorize(assemble(mobility_of));
  if (factors_.info() != Eigen::Success)
    throw meshadapt::Error("the pressure's linear system could not be factorised");
  const Eigen::VectorXd solution = factors_.solve(right);
  Flow flow;
  flow.pressure_of.assign(dual_.vertex_count(), 0);
  for (VertexId v = 0; v < dual_.vertex_count(); ++v)
    if (unknown_of_[v] >= 0) flow.pressure_of[v] = solution[unknown_of_[v]];
  add_velocity(flow, mobility_of);
  return flow;
}

}  // namespace ductile::paper
