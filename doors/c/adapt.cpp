/// @file
/// Adaptation for ductile.h, and the report of a finished one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "handles.hpp"

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

AnyField metric_of(const AnyMesh& mesh, int components, const double* values,
                   const ductile_options& options) {
  if (values == nullptr && options.adapt.curved_sizes)
    return meshadapt::coarsest_metric(mesh, options.adapt.largest_size);
  if (values == nullptr)
    return meshadapt::default_metric(runtime::Executor(options.executor), mesh);
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

/// Throws unless entities can be counted by the C library's signed indices.
void expect_signed(const AnyMesh& mesh) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (mesh.vertex_count() > most || mesh.triangles.size() > most || mesh.tetrahedra.size() > most)
    throw meshadapt::Error("the adapted mesh has more entities than 31 bits can count");
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
  std::string names;
  for (const auto& [known, value] : figures) {
    if (known == name) return value;
    names += names.empty() ? "" : ", ";
    names += known;
  }
  throw InputError("figure " + std::string(name) + ": expected one of " + names);
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

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_adapt(const ductile_mesh* mesh, int components, const double* metric,
                  const ductile_options* options, ductile_mesh** adapted) {
  return c::guarded([&] {
    c::expect_given(mesh, "mesh");
    c::expect_given(adapted, "adapted");
    const ductile_options defaults;
    const ductile_options& used = options == nullptr ? defaults : *options;
    const meshadapt::AnyField wanted = c::metric_of(mesh->mesh, components, metric, used);
    *adapted = c::adapted_by(used, mesh->mesh, [&](const runtime::Executor& executor) {
      return meshadapt::adapt(executor, mesh->mesh, wanted, used.adapt);
    });
  });
}

int ductile_adapt_to_sizes(const ductile_mesh* mesh, const ductile_sizes* sizes,
                           const ductile_options* options, ductile_mesh** adapted) {
  return c::guarded([&] {
    c::expect_given(mesh, "mesh");
    c::expect_given(sizes, "sizes");
    c::expect_given(adapted, "adapted");
    c::expect_dimension_of(*sizes, *mesh);
    const ductile_options defaults;
    const ductile_options& used = options == nullptr ? defaults : *options;
    *adapted = c::adapted_by(used, mesh->mesh, [&](const runtime::Executor& executor) {
      return meshadapt::adapt_to_sizes(executor, mesh->mesh, sizes->sizes, used.adapt);
    });
  });
}

int ductile_solution_metric(const ductile_mesh* mesh, int components, const double* values,
                            const ductile_options* options, double* metric) {
  return c::guarded([&] {
    c::expect_given(mesh, "mesh");
    c::expect_given(values, "values");
    c::expect_given(options, "options");
    c::expect_given(metric, "metric");
    const auto found = meshadapt::solution_metric(runtime::Executor(options->executor), mesh->mesh,
                                                  c::solution_of(mesh->mesh, components, values),
                                                  c::goal_of(*options));
    std::copy(found.metric.values.begin(), found.metric.values.end(), metric);
  });
}

int ductile_mesh_report(const ductile_mesh* adapted, const char* name, double* value) {
  return c::guarded([&] {
    c::expect_given(adapted, "adapted");
    c::expect_given(name, "name");
    c::expect_given(value, "value");
    *value = c::figure(adapted->report, name);
  });
}

const char* ductile_mesh_warning(const ductile_mesh* adapted, int64_t i) {
  if (adapted == nullptr) return nullptr;
  const auto& warnings = adapted->report.warnings;
  if (i < 0 || static_cast<std::size_t>(i) >= warnings.size()) return nullptr;
  return warnings[static_cast<std::size_t>(i)].c_str();
}

}  // extern "C"
