/// @file
/// Adaptation for ductile.h, and the report of a finished one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/move.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "level_set.hpp"

namespace ductile::c {

namespace {

using meshadapt::AdaptReport;
using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::InputError;
using Type = AnyField::Type;

/// The type of a metric with this number of components.
Type type_of(int components, int dimension) {
  for (const Type type : {Type::scalar, Type::symmetric, Type::matrix})
    if (component_count(type, dimension) == components) return type;
  throw InputError("components: expected 1, " +
                   std::to_string(component_count(Type::symmetric, dimension)) + " or " +
                   std::to_string(component_count(Type::matrix, dimension)) + ", found " +
                   std::to_string(components));
}

AnyField metric_of(const ductile_mesh& handle, int components, const double* values,
                   const ductile_options& options) {
  const AnyMesh& mesh = handle.mesh;
  if (values == nullptr && options.adapt.curved_sizes)
    return meshadapt::coarsest_metric(mesh, options.adapt.largest_size);
  if (values == nullptr) {
    const runtime::Executor executor(options.executor);
    return handle.cut ? metric_before(executor, *handle.cut)
                      : meshadapt::default_metric(executor, mesh);
  }
  const Type type = type_of(components, mesh.dimension);
  const std::size_t count = mesh.vertex_count() * static_cast<std::size_t>(components);
  const AnyField given{
      mesh.dimension, mesh.vertex_count(), {type}, {values, values + count}, "metric"};
  return meshadapt::metric_of(given, mesh,
                              {options.adapt.smallest_size, options.adapt.largest_size});
}

/// A field with one scalar per component.
AnyField solution_of(const AnyMesh& mesh, int components, const double* values) {
  if (components < 1)
    throw InputError("components: expected 1 or more, found " + std::to_string(components));
  const auto each = static_cast<std::size_t>(components);
  return {mesh.dimension,
          mesh.vertex_count(),
          std::vector<Type>(each, Type::scalar),
          {values, values + mesh.vertex_count() * each},
          "values"};
}

meshadapt::SolutionMetricOptions goal_of(const ductile_options& options) {
  if (!(options.elements > 0 && std::isfinite(options.elements)))
    throw InputError("option elements: expected a number above 0, found " +
                     number(options.elements));
  return {.goal = {.norm = options.norm,
                   .elements = options.elements,
                   .bounds = {.smallest = options.adapt.smallest_size,
                              .largest = options.adapt.largest_size}},
          .gradation = options.adapt.gradation,
          .recovery = options.projection ? meshadapt::Recovery::double_projection
                                         : meshadapt::Recovery::least_squares};
}

ductile_mesh* handle_of(meshadapt::AdaptedMesh&& result) {
  expect_signed(result.mesh);
  return std::make_unique<ductile_mesh>(ductile_mesh{std::move(result.mesh),
                                                     std::move(result.metric),
                                                     std::move(result.report)})
      .release();
}

double figure(const AdaptReport& report, std::string_view name) {
  const std::array<std::pair<std::string_view, double>, 7> figures{
      {{"iterations", report.iterations},
       {"converged", report.converged ? 1 : 0},
       {"seconds", report.total_seconds},
       {"fixed_vertices", static_cast<double>(report.fixed_vertices)},
       {"held_long_edges", static_cast<double>(report.held_long_edges)},
       {"held_short_edges", static_cast<double>(report.held_short_edges)},
       {"warnings", static_cast<double>(report.warnings.size())}}};
  return named_in(figures, name, "figure");
}

/// Returns a handle to the result of adapt(executor), with a warning for each place where the input
/// is not connected.
template <class Adapt>
ductile_mesh* adapted_by(const ductile_options& options, const meshadapt::AnyMesh& mesh,
                         Adapt&& adapt) {
  const runtime::Executor executor(options.executor);
  meshadapt::AdaptedMesh adapted = adapt(executor);
  for (const std::string& loose : meshadapt::check_conformity(executor, mesh))
    adapted.report.warnings.push_back(loose + "; the mesh is not connected there");
  return handle_of(std::move(adapted));
}

/// The mesh as an adapted one: its iterations are steps.
ductile_mesh* moved_by(const ductile_mesh& mesh, const AnyField& displacement,
                       const ductile_options& used, std::vector<std::int32_t> bodies) {
  const runtime::Executor executor(used.executor);
  meshadapt::MovedMesh moved =
      meshadapt::move(executor, mesh.mesh, displacement,
                      {.bodies = std::move(bodies),
                       .metric = mesh.metric.values.empty() ? nullptr : &mesh.metric,
                       .smallest_size = used.adapt.smallest_size,
                       .largest_size = used.adapt.largest_size,
                       .gradation = std::max(0.0, used.adapt.gradation)});
  AdaptReport report;
  report.iterations = moved.report.steps;
  report.converged = true;
  report.total_seconds = moved.report.total_seconds;
  report.warnings = std::move(moved.report.warnings);
  ductile_mesh* const handle =
      handle_of({std::move(moved.mesh), std::move(moved.metric), std::move(report)});
  handle->origins = std::move(moved.origins);
  return handle;
}

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_adapt(const ductile_mesh* mesh, int components, const double* metric,
                  const ductile_options* options, ductile_mesh** adapted) {
  return c::guarded({{mesh, "mesh"}, {adapted, "adapted"}}, [&] {
    const ductile_options& used = c::or_defaults(options);
    const meshadapt::AnyField wanted = c::metric_of(*mesh, components, metric, used);
    const meshadapt::AdaptOptions adapt = c::on_surface(*mesh, used);
    *adapted = c::adapted_by(used, mesh->mesh, [&](const runtime::Executor& executor) {
      return meshadapt::adapt(executor, mesh->mesh, wanted, adapt);
    });
  });
}

int ductile_adapt_to_sizes(const ductile_mesh* mesh, const ductile_sizes* sizes,
                           const ductile_options* options, ductile_mesh** adapted) {
  return c::guarded({{mesh, "mesh"}, {sizes, "sizes"}, {adapted, "adapted"}}, [&] {
    c::expect_dimension_of(*sizes, *mesh);
    const ductile_options& used = c::or_defaults(options);
    const meshadapt::AdaptOptions adapt = c::on_surface(*mesh, used);
    *adapted = c::adapted_by(used, mesh->mesh, [&](const runtime::Executor& executor) {
      return meshadapt::adapt_to_sizes(executor, mesh->mesh, sizes->sizes, adapt);
    });
  });
}

int ductile_move(const ductile_mesh* mesh, const double* displacement, int64_t count,
                 const int32_t* bodies, const ductile_options* options, ductile_mesh** moved) {
  return c::guarded({{mesh, "mesh"}, {displacement, "displacement"}}, [&] {
    c::expect_array(bodies, count, "bodies");
    c::expect_given(moved, "moved");
    const meshadapt::AnyMesh& any = mesh->mesh;
    const meshadapt::AnyField field{any.dimension,
                                    any.vertex_count(),
                                    {meshadapt::AnyField::Type::vector},
                                    {displacement, displacement + any.coordinates.size()},
                                    "displacement"};
    *moved = c::moved_by(*mesh, field, c::or_defaults(options), {bodies, bodies + count});
  });
}

int ductile_move_origins(const ductile_mesh* moved, int32_t* vertices, int32_t* facets,
                         int32_t* elements) {
  return c::guarded({{moved, "moved"}}, [&] {
    const meshadapt::Origins& origins = moved->origins;
    if (origins.vertex.empty())
      throw meshadapt::InputError("moved: expected a mesh from ductile_move(), found another");
    const auto copy = [](const std::vector<std::uint32_t>& from, int32_t* to) {
      if (to != nullptr)
        std::ranges::transform(from, to, [](std::uint32_t i) { return static_cast<int32_t>(i); });
    };
    copy(origins.vertex, vertices);
    copy(origins.facet, facets);
    copy(origins.element, elements);
  });
}

int ductile_solution_metric(const ductile_mesh* mesh, int components, const double* values,
                            const ductile_options* options, double* metric) {
  return c::guarded({{mesh, "mesh"}, {values, "values"}, {options, "options"}, {metric, "metric"}},
                    [&] {
                      const auto found = meshadapt::solution_metric(
                          runtime::Executor(options->executor), mesh->mesh,
                          c::solution_of(mesh->mesh, components, values), c::goal_of(*options));
                      std::copy(found.metric.values.begin(), found.metric.values.end(), metric);
                    });
}

int ductile_mesh_report(const ductile_mesh* adapted, const char* name, double* value) {
  return c::guarded({{adapted, "adapted"}, {name, "name"}, {value, "value"}}, [&] {
    *value = adapted->cut ? c::cut_figure(adapted->cut->made.report, name)
                          : c::figure(adapted->report, name);
  });
}

const char* ductile_mesh_warning(const ductile_mesh* adapted, int64_t i) {
  if (adapted == nullptr) return nullptr;
  const auto& warnings = adapted->report.warnings;
  if (i < 0 || static_cast<std::size_t>(i) >= warnings.size()) return nullptr;
  return warnings[static_cast<std::size_t>(i)].c_str();
}

}  // extern "C"
