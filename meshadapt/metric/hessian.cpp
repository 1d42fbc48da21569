#include "ductile/meshadapt/hessian_metric.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>

#include "core/small_system.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/wording.hpp"
#include "metric/charts.hpp"
#include "metric/surroundings.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// Surroundings that do not determine a fit after this many layers never will.
constexpr int most_layers = 5;

/// A pivot below this, relatively, says that the vertices around lie badly: on a conic, on a line.
constexpr double least_pivot = 1e-2;

/// Then what is undetermined is kept small by this.
constexpr double regularisation = 1e-6;

template <int Dim>
struct Derivatives {
  Vector<Dim> gradient;
  Metric<Dim> hessian;
};

// ---- Least squares ----

template <int Dim, int Space = Dim>
class QuadraticFit {
 public:
  QuadraticFit(const Executor& executor, const Charts<Dim, Space>& charts,
               std::span<const double> value_of)
      : charts_(charts), mesh_(charts.mesh()), value_of_(value_of), buffer_(executor) {}

  /// The derivatives of the quadratic at a vertex. Thread safety: any thread of the executor.
  Derivatives<Dim> at(VertexId vertex) {
    if (mesh_.elements_of(vertex).empty()) return {};
    Surroundings<Dim>& around = buffer_.mine();
    around.start(mesh_, vertex);
    if (mesh_.on_boundary[vertex] != 0) around.grow(mesh_);
    for (int layer = 1; layer < most_layers; ++layer) {
      if (around.vertices().size() > unknowns)
        if (const auto found = fit(around, 0)) return *found;
      if (!around.grow(mesh_)) break;
    }
    return fit(around, regularisation).value_or(Derivatives<Dim>{});
  }

 private:
  static constexpr std::size_t unknowns = Dim + Metric<Dim>::size;
  using System = SmallSystem<unknowns>;

  std::optional<Derivatives<Dim>> fit(const Surroundings<Dim>& around, double regularise) const {
    const VertexId centre = around.centre();
    Shape<Dim> shape;
    for (const VertexId v : around.vertices()) shape.add(charts_.offset(centre, v));
    shape.factorise();
    System system;
    for (const VertexId v : around.vertices()) {
      const Vector<Dim> d = shape.seen(charts_.offset(centre, v));
      const double weight = 1 / norm(d);
      system.add(row(d, weight), {weight * (value_of_[v] - value_of_[centre])});
    }
    if (regularise > 0) system.regularise(regularise);
    if (!system.solve(regularise > 0 ? 0 : least_pivot)) return std::nullopt;
    return derivatives(system, shape);
  }

  /// d'g + d'Hd/2 as a linear function of g and the components of H.
  static typename System::Row row(const Vector<Dim>& d, double weight) {
    typename System::Row result;
    for (std::size_t i = 0; i < Dim; ++i) result[i] = weight * d.x[i];
    for (std::size_t column = 0, at = Dim; column < Dim; ++column)
      for (std::size_t i = 0; i <= column; ++i, ++at)
        result[at] = weight * d.x[i] * d.x[column] * (i == column ? 0.5 : 1);
    return result;
  }

  static Derivatives<Dim> derivatives(const System& system, const Shape<Dim>& shape) {
    Derivatives<Dim> result;
    Metric<Dim> seen;
    for (int i = 0; i < Dim; ++i) result.gradient[i] = system.solution(static_cast<std::size_t>(i));
    for (std::size_t i = 0; i < seen.m.size(); ++i) seen.m[i] = system.solution(Dim + i);
    result.gradient = shape.unseen(result.gradient);
    std::array<Vector<Dim>, Dim> half;  // [column of H there], L^-T H
    for (int j = 0; j < Dim; ++j) {
      for (int i = 0; i < Dim; ++i) half[static_cast<std::size_t>(j)][i] = seen(i, j);
      half[static_cast<std::size_t>(j)] = shape.unseen(half[static_cast<std::size_t>(j)]);
    }
    for (std::size_t row = 0; row < Dim; ++row) {
      Vector<Dim> across;
      for (std::size_t j = 0; j < Dim; ++j) across.x[j] = half[j].x[row];
      across = shape.unseen(across);
      for (std::size_t column = row; column < Dim; ++column)
        result.hessian.m[column * (column + 1) / 2 + row] = across.x[column];
    }
    return result;
  }

  const Charts<Dim, Space>& charts_;
  const FixedMesh<Dim, Space>& mesh_;
  std::span<const double> value_of_;
  runtime::PerThread<Surroundings<Dim>> buffer_;
};

// ---- Double projection ----

/// The gradients of the elements, as their mean at each vertex, weighted by volume.
template <int Dim, class Value>
std::vector<Vector<Dim>> project_gradients(const Executor& executor, const FixedMesh<Dim>& mesh,
                                           Value&& value) {
  std::vector<Vector<Dim>> in_element(mesh.element_count());  // times the volume
  parallel_for(executor, mesh.element_count(), [&](std::size_t e) {
    const auto hat = hat_gradients<Dim>(mesh.points(static_cast<ElementId>(e)));
    for (std::size_t i = 0; i <= Dim; ++i)
      in_element[e] += mesh.volume_of[e] * value(mesh.corners_of[e][i]) * hat[i];
  });
  std::vector<Vector<Dim>> gradient_of(mesh.vertex_count());
  parallel_for(executor, mesh.vertex_count(), [&](std::size_t v) {
    for (const ElementId element : mesh.elements_of(static_cast<VertexId>(v)))
      gradient_of[v] += in_element[element];
    if (mesh.share_of[v] > 0) gradient_of[v] *= 1 / ((Dim + 1) * mesh.share_of[v]);
  });
  return gradient_of;
}

/// Replaces what is at boundary vertices by what vertices inside say about it.
template <int Dim>
class FromInside {
 public:
  FromInside(const Executor& executor, const FixedMesh<Dim>& mesh)
      : executor_(executor), mesh_(mesh), buffer_(executor) {}

  /// Extends a linear function, the closest in the sense of least squares. Where the vertices
  /// inside do not determine one, it is constant in the directions that are missing.
  void extrapolate_linearly(std::vector<Vector<Dim>>& gradient_of) {
    at_boundary([&](const Surroundings<Dim>& around, bool last) {
      const std::size_t enough = last ? 1 : 2 * (Dim + 1);
      if (inside(around) < enough) return false;
      return extrapolate(gradient_of, around, last);
    });
  }

  /// Takes the mean.
  void extend(std::vector<Metric<Dim>>& tensor_of) {
    at_boundary([&](const Surroundings<Dim>& around, bool) {
      const std::size_t count = inside(around);
      if (count == 0) return false;
      Metric<Dim> sum;
      for (const VertexId v : around.vertices())
        if (mesh_.on_boundary[v] == 0) sum += tensor_of[v];
      tensor_of[around.centre()] = 1.0 / static_cast<double>(count) * sum;
      return true;
    });
  }

 private:
  /// Calls find(surroundings, last) for each boundary vertex and ever larger surroundings until it
  /// says that these sufficed. It may write at the vertex and read inside.
  template <class Find>
  void at_boundary(Find&& find) {
    parallel_for(executor_, mesh_.vertex_count(), [&](std::size_t v) {
      if (mesh_.on_boundary[v] == 0) return;
      Surroundings<Dim>& around = buffer_.mine();
      around.start(mesh_, static_cast<VertexId>(v));
      bool found = false;
      for (int layer = 1; layer < most_layers && !found; ++layer) {
        found = find(around, false);
        if (!found && !around.grow(mesh_)) break;
      }
      if (!found) find(around, true);
    });
  }

  std::size_t inside(const Surroundings<Dim>& around) const {
    std::size_t count = 0;
    for (const VertexId v : around.vertices()) count += mesh_.on_boundary[v] == 0;
    return count;
  }

  bool extrapolate(std::vector<Vector<Dim>>& gradient_of, const Surroundings<Dim>& around,
                   bool last) const {
    Shape<Dim> shape;
    Vector<Dim> mean, centre;
    for (const VertexId v : around.vertices()) {
      shape.add(mesh_.position_of[v] - mesh_.position_of[around.centre()]);
      if (mesh_.on_boundary[v] != 0) continue;
      mean += gradient_of[v];
      centre += mesh_.position_of[v];
    }
    shape.factorise();
    const double scale = 1 / static_cast<double>(inside(around));
    mean *= scale;
    centre *= scale;
    SmallSystem<Dim, Dim> system;
    for (const VertexId v : around.vertices())
      if (mesh_.on_boundary[v] == 0)
        system.add(shape.seen(mesh_.position_of[v] - centre).x, (gradient_of[v] - mean).x);
    if (last) system.regularise(regularisation);
    if (!system.solve(last ? 0 : least_pivot)) return last;
    const Vector<Dim> d = shape.seen(mesh_.position_of[around.centre()] - centre);
    Vector<Dim>& result = gradient_of[around.centre()] = mean;
    for (std::size_t axis = 0; axis < Dim; ++axis)
      for (std::size_t i = 0; i < Dim; ++i) result.x[axis] += d.x[i] * system.solution(i, axis);
    return true;
  }

  const Executor& executor_;
  const FixedMesh<Dim>& mesh_;
  runtime::PerThread<Surroundings<Dim>> buffer_;
};

template <int Dim>
std::vector<Vector<Dim>> projected_gradient(const Executor& executor, const FixedMesh<Dim>& mesh,
                                            std::span<const double> value_of) {
  auto gradient_of = project_gradients(executor, mesh, [&](VertexId v) { return value_of[v]; });
  FromInside<Dim>(executor, mesh).extrapolate_linearly(gradient_of);
  return gradient_of;
}

template <int Dim>
std::vector<Metric<Dim>> projected_hessian(const Executor& executor, const FixedMesh<Dim>& mesh,
                                           std::span<const double> value_of) {
  const auto gradient_of = projected_gradient(executor, mesh, value_of);
  std::vector<Metric<Dim>> hessian_of(mesh.vertex_count());
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const auto row_of =
        project_gradients(executor, mesh, [&](VertexId v) { return gradient_of[v].x[axis]; });
    parallel_for(executor, mesh.vertex_count(), [&](std::size_t v) {
      for (std::size_t i = 0; i < Dim; ++i) {
        const auto [row, column] = std::minmax(i, axis);
        hessian_of[v].m[column * (column + 1) / 2 + row] += row_of[v].x[i] * (i == axis ? 1 : 0.5);
      }
    });
  }
  FromInside<Dim>(executor, mesh).extend(hessian_of);
  return hessian_of;
}

template <int Dim>
AnyField hessians_of(const Executor& executor, const AnyMesh& any, const AnyField& field,
                     Recovery recovery) {
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  const std::size_t stride = stride_of(field);
  constexpr std::size_t size = Metric<Dim>::size;
  AnyField result;
  result.dimension = Dim;
  result.vertex_count = field.vertex_count;
  result.types.assign(stride, AnyField::Type::symmetric);
  result.values.resize(field.vertex_count * stride * size);
  result.name = field.name;
  std::vector<double> value_of(field.vertex_count);
  for (std::size_t component = 0; component < stride; ++component) {
    parallel_for(executor, value_of.size(),
                 [&](std::size_t v) { value_of[v] = field.values[v * stride + component]; });
    const auto hessian_of = recover_hessian<Dim>(executor, mesh, value_of, recovery);
    parallel_for(executor, value_of.size(), [&](std::size_t v) {
      std::copy_n(
          hessian_of[v].m.begin(), size,
          result.values.begin() + static_cast<std::ptrdiff_t>((v * stride + component) * size));
    });
  }
  return result;
}

}  // namespace

template <int Dim>
std::vector<Vector<Dim>> recover_gradient(const Executor& executor, const FixedMesh<Dim>& mesh,
                                          std::span<const double> value_of, Recovery recovery) {
  expect_at_each_vertex("value_of: expected a value", mesh.vertex_count(), value_of.size());
  if (recovery == Recovery::double_projection) return projected_gradient(executor, mesh, value_of);
  std::vector<VertexId> all(mesh.vertex_count());
  std::iota(all.begin(), all.end(), VertexId{0});
  return recover_gradient_at<Dim>(executor, mesh, value_of, all);
}

template <int Dim>
std::vector<Vector<Dim>> recover_gradient_at(const Executor& executor, const FixedMesh<Dim>& mesh,
                                             std::span<const double> value_of,
                                             std::span<const VertexId> at) {
  expect_at_each_vertex("value_of: expected a value", mesh.vertex_count(), value_of.size());
  const Charts<Dim> charts(executor, mesh);
  QuadraticFit<Dim> fit(executor, charts, value_of);
  std::vector<Vector<Dim>> gradient_of(at.size());
  parallel_for(executor, at.size(),
               [&](std::size_t i) { gradient_of[i] = fit.at(at[i]).gradient; });
  return gradient_of;
}

template <int Dim>
std::vector<Metric<Dim>> recover_hessian(const Executor& executor, const FixedMesh<Dim>& mesh,
                                         std::span<const double> value_of, Recovery recovery) {
  expect_at_each_vertex("value_of: expected a value", mesh.vertex_count(), value_of.size());
  if (recovery == Recovery::double_projection) return projected_hessian(executor, mesh, value_of);
  return fitted_hessian(executor, Charts<Dim>(executor, mesh), value_of);
}

template <int Dim, int Space>
std::vector<Metric<Dim>> fitted_hessian(const Executor& executor, const Charts<Dim, Space>& charts,
                                        std::span<const double> value_of) {
  QuadraticFit<Dim, Space> fit(executor, charts, value_of);
  std::vector<Metric<Dim>> hessian_of(value_of.size());
  parallel_for(executor, value_of.size(),
               [&](std::size_t v) { hessian_of[v] = fit.at(static_cast<VertexId>(v)).hessian; });
  return hessian_of;
}

AnyField recover_hessian(const Executor& executor, const AnyMesh& mesh, const AnyField& field,
                         Recovery recovery) {
  expect_field_of(field, mesh);
  return mesh.dimension == 2 ? hessians_of<2>(executor, mesh, field, recovery)
                             : hessians_of<3>(executor, mesh, field, recovery);
}

template std::vector<Vector<2>> recover_gradient(const Executor&, const FixedMesh<2>&,
                                                 std::span<const double>, Recovery);
template std::vector<Vector<3>> recover_gradient(const Executor&, const FixedMesh<3>&,
                                                 std::span<const double>, Recovery);
template std::vector<Vector<2>> recover_gradient_at(const Executor&, const FixedMesh<2>&,
                                                    std::span<const double>,
                                                    std::span<const VertexId>);
template std::vector<Vector<3>> recover_gradient_at(const Executor&, const FixedMesh<3>&,
                                                    std::span<const double>,
                                                    std::span<const VertexId>);
template std::vector<Metric<2>> recover_hessian(const Executor&, const FixedMesh<2>&,
                                                std::span<const double>, Recovery);
template std::vector<Metric<3>> recover_hessian(const Executor&, const FixedMesh<3>&,
                                                std::span<const double>, Recovery);
template std::vector<Metric<2>> fitted_hessian(const Executor&, const Charts<2>&,
                                               std::span<const double>);
template std::vector<Metric<2>> fitted_hessian(const Executor&, const Charts<2, 3>&,
                                               std::span<const double>);
template std::vector<Metric<3>> fitted_hessian(const Executor&, const Charts<3>&,
                                               std::span<const double>);

}  // namespace ductile::meshadapt
