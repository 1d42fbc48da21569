/// @file
/// Transfer between meshes for ductile.h: origins, hosts and fields.
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "ductile/meshadapt/transfer.hpp"
#include "handles.hpp"

struct ductile_transfer {
  const ductile_mesh& before;
  const ductile_mesh& after;
  ductile::meshadapt::Origins origins;
};

namespace ductile::c {

namespace {

using meshadapt::AnyMesh;
using meshadapt::Carrying;
using meshadapt::InputError;

/// The place, vertices or elements, that a kind of entities stands for.
meshadapt::NamedField::Place place_of(int kind) {
  if (kind == DUCTILE_VERTICES) return meshadapt::NamedField::Place::vertices;
  if (kind == DUCTILE_ELEMENTS) return meshadapt::NamedField::Place::elements;
  throw InputError("how: expected DUCTILE_VERTICES or DUCTILE_ELEMENTS, found " +
                   std::to_string(kind));
}

std::size_t entity_count(const AnyMesh& mesh, int kind) {
  if (kind == DUCTILE_VERTICES) return mesh.vertex_count();
  return element_dimension(mesh) == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

/// The indices as signed numbers, so that `none` is -1. The signed type may alias the unsigned one.
const std::int32_t* signed_data(const std::vector<std::uint32_t>& indices) {
  static_assert(static_cast<std::int32_t>(meshadapt::none) == -1);
  return indices.empty() ? nullptr : reinterpret_cast<const std::int32_t*>(indices.data());
}

/// Splits values, entity after entity, into one field per component.
std::vector<meshadapt::NamedField> fields_of(const double* values, std::size_t count,
                                             std::size_t components,
                                             meshadapt::NamedField::Place place) {
  std::vector<meshadapt::NamedField> fields(components);
  for (std::size_t k = 0; k < components; ++k) {
    fields[k].place = place;
    fields[k].name = "component " + std::to_string(k);
    for (std::size_t i = 0; i < count; ++i) fields[k].values.push_back(values[i * components + k]);
  }
  return fields;
}

void copy_to(double* values, const std::vector<meshadapt::NamedField>& fields) {
  for (std::size_t k = 0; k < fields.size(); ++k)
    for (std::size_t i = 0; i < fields[k].values.size(); ++i)
      values[i * fields.size() + k] = fields[k].values[i];
}

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_transfer_create(const ductile_mesh* before, const ductile_mesh* after,
                            ductile_transfer** transfer) {
  return c::guarded({{before, "before"}, {after, "after"}, {transfer, "transfer"}}, [&] {
    *transfer =
        std::make_unique<ductile_transfer>(
            ductile_transfer{*before, *after,
                             meshadapt::origins(runtime::Executor(), before->mesh, after->mesh)})
            .release();
  });
}

void ductile_transfer_destroy(ductile_transfer* transfer) { delete transfer; }

const int32_t* ductile_transfer_origins(const ductile_transfer* transfer, int kind) {
  if (transfer == nullptr) return nullptr;
  const meshadapt::Origins& origins = transfer->origins;
  if (kind == DUCTILE_FACETS && is_surface(transfer->after.mesh)) kind = DUCTILE_ELEMENTS;
  return kind == DUCTILE_VERTICES   ? c::signed_data(origins.vertex)
         : kind == DUCTILE_FACETS   ? c::signed_data(origins.facet)
         : kind == DUCTILE_ELEMENTS ? c::signed_data(origins.element)
                                    : nullptr;
}

const int32_t* ductile_transfer_hosts(const ductile_transfer* transfer) {
  return transfer == nullptr ? nullptr : c::signed_data(transfer->origins.host);
}

const double* ductile_transfer_weights(const ductile_transfer* transfer) {
  return transfer == nullptr || transfer->origins.weight.empty() ? nullptr
                                                                 : transfer->origins.weight.data();
}

int ductile_transfer_carry(const ductile_transfer* transfer, int how, int components,
                           const double* values, double* result) {
  return c::guarded({{transfer, "transfer"}, {values, "values"}, {result, "result"}}, [&] {
    if (components < 1)
      throw meshadapt::InputError("components: expected 1 or more, found " +
                                  std::to_string(components));
    const bool conservative = (how & DUCTILE_CONSERVATIVE) != 0;
    const int kind = how & ~DUCTILE_CONSERVATIVE;
    const c::AnyMesh& before = transfer->before.mesh;
    const auto place = c::place_of(kind);
    const auto fields = c::fields_of(values, c::entity_count(before, kind),
                                     static_cast<std::size_t>(components), place);
    const auto carrying = conservative ? c::Carrying::conservatively : c::Carrying::by_value;
    c::copy_to(result, meshadapt::transfer_fields(runtime::Executor(), {before, fields},
                                                  transfer->after.mesh, {carrying})
                           .fields);
  });
}

}  // extern "C"
