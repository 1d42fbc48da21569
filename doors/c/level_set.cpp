/// @file
/// Level sets for ductile.h: a mesh is cut, and its handle keeps what adapting it needs.
#include "level_set.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "ductile/meshadapt/level_set_function.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace ductile::c {

meshadapt::AnyField metric_before(const runtime::Executor& executor, const Cut& cut) {
  return meshadapt::metric_at_cut(executor, meshadapt::default_metric(executor, cut.before),
                                  cut.made);
}

meshadapt::AdaptOptions on_surface(const ductile_mesh& mesh, const ductile_options& options) {
  meshadapt::AdaptOptions adapt = options.adapt;
  if (!mesh.cut || adapt.make.hausdorff_tolerance <= 0 || adapt.make.geometry ||
      mesh.cut->made.report.interface_facets == 0 || mesh.cut->made.report.on_surface)
    return adapt;
  const Cut& cut = *mesh.cut;
  const meshadapt::LevelSetFunction function(runtime::Executor(options.executor), cut.before,
                                             cut.values, cut.made.report.level);
  adapt.make.functions.push_back(function.surface(cut.interface, adapt.make.hausdorff_tolerance));
  return adapt;
}

double cut_figure(const meshadapt::CutReport& report, std::string_view name) {
  const std::array<std::pair<std::string_view, double>, 6> figures{
      {{"level", report.level},
       {"volume_below", report.minus_volume},
       {"cut_elements", static_cast<double>(report.cut_elements)},
       {"moved_vertices", static_cast<double>(report.moved_vertices)},
       {"removed_components", static_cast<double>(report.removed_components)},
       {"warnings", static_cast<double>(report.warnings.size())}}};
  return named_in(figures, name, "figure");
}

namespace {

void write_origins(const meshadapt::CutMesh& made, int32_t* vertices, double* weights,
                   int32_t* elements) {
  for (std::size_t v = 0; v < made.vertex_origin.size(); ++v) {
    const auto& [a, b, t] = made.vertex_origin[v];
    if (vertices != nullptr) {
      vertices[2 * v] = static_cast<int32_t>(a);
      vertices[2 * v + 1] = static_cast<int32_t>(b);
    }
    if (weights != nullptr) weights[v] = t;
  }
  if (elements == nullptr) return;
  std::transform(made.element_origin.begin(), made.element_origin.end(), elements,
                 [](std::uint32_t element) { return static_cast<int32_t>(element); });
}

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_options_set_material(ductile_options* options, int32_t reference, int split,
                                 int32_t minus, int32_t plus) {
  return c::guarded({{options, "options"}}, [&] {
    if (split != 0 && split != 1)
      throw meshadapt::InputError("split: expected 0 or 1, found " + std::to_string(split));
    auto& materials = options->cut.materials;
    std::erase_if(materials, [&](const auto& m) { return m.reference == reference; });
    materials.push_back({reference, split == 1, minus, plus});
  });
}

int ductile_cut(const ductile_mesh* mesh, const double* values, const ductile_options* options,
                ductile_mesh** cut) {
  return c::guarded({{mesh, "mesh"}, {values, "values"}, {cut, "cut"}}, [&] {
    const ductile_options& used = c::or_defaults(options);
    const meshadapt::AnyMesh& before = mesh->mesh;
    auto kept = std::make_shared<c::Cut>(
        c::Cut{before, {values, values + before.vertex_count()}, used.cut.interface, {}});
    kept->made = meshadapt::cut(runtime::Executor(used.executor), before, kept->values, used.cut);
    c::expect_signed(kept->made.mesh);
    auto made = std::make_unique<ductile_mesh>();
    made->mesh = std::move(kept->made.mesh);
    kept->made.mesh = {};
    kept->made.mesh.dimension = before.dimension;
    made->report.warnings = kept->made.report.warnings;
    made->cut = std::move(kept);
    *cut = made.release();
  });
}

int ductile_cut_origins(const ductile_mesh* cut, int32_t* vertices, double* weights,
                        int32_t* elements) {
  return c::guarded({{cut, "cut"}}, [&] {
    if (!cut->cut)
      throw meshadapt::InputError("cut: expected a mesh from ductile_cut(), found another");
    c::write_origins(cut->cut->made, vertices, weights, elements);
  });
}

}  // extern "C"
