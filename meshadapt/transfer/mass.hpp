/// @file
/// Mass<Dim>: the mass matrix of linear elements, without storing it: products, its inverse, and
/// its lumped form. Values are [vertex * stride + component].
#pragma once

#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Mass {
 public:
  /// Refers to all arguments. For a mesh that is part of a larger one, `join` is given and vertices
  /// have their shares in the whole.
  Mass(const runtime::Executor& executor, const FixedMesh<Dim>& mesh, std::size_t stride,
       const JoinParts& join)
      : executor_(executor), mesh_(mesh), stride_(stride), join_(join) {}

  /// Integral of the product of the hat functions of two corners of an element.
  double between(std::size_t element) const {
    return mesh_.volume_of[element] / ((Dim + 1) * (Dim + 2));
  }

  /// Returns M x.
  std::vector<double> product(const std::vector<double>& x) const {
    std::vector<double> sum(mesh_.element_count() * stride_);  // sums over corners, times between()
    runtime::parallel_for(executor_, mesh_.element_count(), [&](std::size_t e) {
      for (const VertexId v : mesh_.corners_of[e])
        for (std::size_t k = 0; k < stride_; ++k)
          sum[e * stride_ + k] += between(e) * x[v * stride_ + k];
    });
    std::vector<double> result(x.size());
    const bool is_part = static_cast<bool>(join_);
    const auto own = [&](std::size_t i) { return mesh_.share_of[i / stride_] / (Dim + 2) * x[i]; };
    runtime::parallel_for(executor_, mesh_.vertex_count(), [&](std::size_t v) {
      double* const at = &result[v * stride_];
      for (std::size_t k = 0; k < stride_; ++k) at[k] = is_part ? 0 : own(v * stride_ + k);
      for (const ElementId e : mesh_.elements_of(static_cast<VertexId>(v)))
        for (std::size_t k = 0; k < stride_; ++k) at[k] += sum[e * stride_ + k];
    });
    if (is_part) {
      join_(result, stride_, Joining::sum);
      runtime::parallel_for(executor_, result.size(), [&](std::size_t i) { result[i] += own(i); });
    }
    return result;
  }

  /// Returns the x with M x = b, up to rounding, from a first guess. Uses Chebyshev iteration: with
  /// the diagonal as preconditioner all eigenvalues lie between 1/2 and (d + 2)/2 on any mesh
  /// (Wathen, IMA J. Numer. Anal. 7, 1987), so it needs no scalar products and a fixed number of
  /// steps.
  std::vector<double> solve(const std::vector<double>& b, std::vector<double> x) const {
    constexpr int steps = Dim == 2 ? 32 : 38;  // each divides the error by 3 or 2.6
    constexpr double middle = (Dim + 3) / 4.0, radius = (Dim + 1) / 4.0;
    std::vector<double> move(x.size());
    double rho = radius / middle;
    for (int step = 0; step < steps; ++step) {
      const std::vector<double> reached = product(x);
      const double next = step == 0 ? 0 : 1 / (2 * middle / radius - rho);
      const double keep = next * rho;
      const double add = step == 0 ? 1 / middle : 2 * next / radius;
      if (step > 0) rho = next;
      runtime::parallel_for(executor_, mesh_.vertex_count(), [&](std::size_t v) {
        if (!(mesh_.share_of[v] > 0)) return;
        const double diagonal = 2 * mesh_.share_of[v] / (Dim + 2);
        for (std::size_t i = v * stride_; i < (v + 1) * stride_; ++i) {
          move[i] = keep * move[i] + add * (b[i] - reached[i]) / diagonal;
          x[i] += move[i];
        }
      });
    }
    return x;
  }

  /// Contributions of an element to M_lumped x - M x: visit(corner, component, amount). They sum to
  /// 0.
  template <class Visit>
  void excess(std::size_t element, const std::vector<double>& x, Visit&& visit) const {
    for (std::size_t k = 0; k < stride_; ++k) {
      double sum = 0;
      for (const VertexId v : mesh_.corners_of[element]) sum += x[v * stride_ + k];
      for (std::size_t i = 0; i <= Dim; ++i)
        visit(i, k,
              between(element) * ((Dim + 1) * x[mesh_.corners_of[element][i] * stride_ + k] - sum));
    }
  }

 private:
  const runtime::Executor& executor_;
  const FixedMesh<Dim>& mesh_;
  std::size_t stride_;
  const JoinParts& join_;
};

}  // namespace ductile::meshadapt
