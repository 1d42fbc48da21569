/// @file
/// Transfer of named fields. Fields on the same entities with the same method are transferred
/// together, because locating entities takes longer than copying values.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/wording.hpp"
#include "transfer/conservative_transfer.hpp"
#include "transfer/element_fields.hpp"
#include "transfer/places.hpp"
#include "transfer/vertex_places.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

using Where = NamedField::Place;

std::size_t components(const NamedField& field, int dimension) {
  return static_cast<std::size_t>(component_count(field.type, dimension));
}

std::size_t entity_count(const AnyMesh& mesh, Where place) {
  if (place == Where::vertices) return mesh.vertex_count();
  return element_dimension(mesh) == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

/// The name of a field in messages.
Wording called(const NamedField& field, std::size_t index) {
  const std::string name = field.name.empty() ? "" : " \"" + field.name + "\"";
  return {"fields[" + std::to_string(index) + "]" + name,
          "field" + (name.empty() ? " " + std::to_string(index + 1) : name)};
}

void expect_field(const Executor& executor, const NamedFieldsOnMesh& from, std::size_t index,
                  Carrying carrying) {
  const NamedField& field = from.fields[index];
  const int type = static_cast<int>(field.type);
  if (type < 1 || type > 4)
    refuse(called(field, index) + ": expected a type from 1 to 4, found " + std::to_string(type));
  const std::size_t each = components(field, from.mesh.dimension);
  const std::size_t count = entity_count(from.mesh, field.place);
  const bool at_vertices = field.place == Where::vertices;
  if (field.values.size() != each * count)
    refuse(called(field, index) + ": expected " + std::to_string(each) +
           " numbers in values for each of the " + std::to_string(count) +
           (at_vertices ? " vertices" : " elements") + ", found " +
           std::to_string(field.values.size()));
  if (carrying == Carrying::by_value) return;
  const std::size_t bad = first_bad(executor, field.values.size(),
                                    [&](std::size_t i) { return !std::isfinite(field.values[i]); });
  if (bad != no_index)
    refuse(called(field, index) + ": expected finite numbers, found " +
           std::to_string(field.values[bad]) + " at " +
           Wording("values[" + std::to_string(bad) + "]",
                   (at_vertices ? "vertex " : "element ") + std::to_string(bad / each + 1)));
}

template <int Dim, int Space>
class FieldCarrier {
 public:
  FieldCarrier(const Executor& executor, const NamedFieldsOnMesh& from, const AnyMesh& to,
               const JoinParts& join)
      : executor_(executor),
        fields_(from.fields),
        join_(join),
        old_mesh_(make_fixed_mesh<Dim, Space>(executor, from.mesh)),
        new_mesh_(make_fixed_mesh<Dim, Space>(executor, to)),
        to_(to),
        locator_(executor, old_mesh_) {
    if (join_) join_(new_mesh_.share_of, 1, Joining::sum);
    result_.fields.resize(fields_.size());
  }

  /// Transfers the fields with these indices, all on entities of one kind.
  void carry(const std::vector<std::size_t>& which, Where place, Carrying carrying) {
    if (which.empty()) return;
    std::size_t stride = 0;
    for (const std::size_t f : which) stride += components(fields_[f], Space);
    const std::vector<double> values = side_by_side(which, stride);
    split(which, stride, carried({values, stride}, place, carrying));
    if (place == Where::elements && carrying == Carrying::by_value)
      for (const std::size_t f : which) result_.fields[f].whole = fields_[f].whole;
  }

  TransferredFields take_result() { return std::move(result_); }

 private:
  std::vector<double> carried(const Components& field, Where place, Carrying carrying) {
    TransferReport& report = result_.report;
    Coverage coverage;
    std::vector<double> values;
    if (place == Where::elements) {
      const ElementFields<Dim, Space> fields(executor_, locator_, field, new_mesh_);
      if (carrying == Carrying::by_value) return fields.at_centroids();
      if constexpr (Dim == Space) values = fields.means(coverage);
    } else {
      Evaluated at_vertices = evaluate_at_vertices(executor_, locator_, field, to_);
      report.vertices_outside = at_vertices.outside;
      if (carrying == Carrying::by_value) {
        if (join_) join_(at_vertices.values, field.stride, Joining::first);
        return std::move(at_vertices.values);
      }
      if constexpr (Dim == Space) {
        ConservativeTransfer<Dim> onto(executor_, locator_, field, new_mesh_, join_);
        values = onto.run({});
        coverage = onto.coverage();
      }
    }
    report.volume_outside = coverage.volume_outside;
    report.volume_left_out = coverage.volume_left_out;
    return values;
  }

  /// Interleaves all components of each entity.
  std::vector<double> side_by_side(const std::vector<std::size_t>& which,
                                   std::size_t stride) const {
    const std::size_t count =
        fields_[which[0]].values.size() / components(fields_[which[0]], Space);
    std::vector<double> values(count * stride);
    std::size_t first = 0;
    for (const std::size_t f : which) {
      const std::size_t each = components(fields_[f], Space);
      runtime::parallel_for(executor_, count, [&](std::size_t i) {
        std::copy_n(&fields_[f].values[i * each], each, &values[i * stride + first]);
      });
      first += each;
    }
    return values;
  }

  void split(const std::vector<std::size_t>& which, std::size_t stride,
             const std::vector<double>& values) {
    const std::size_t count = values.size() / stride;
    std::size_t first = 0;
    for (const std::size_t f : which) {
      const std::size_t each = components(fields_[f], Space);
      NamedField& field = result_.fields[f];
      field = {.name = fields_[f].name,
               .type = fields_[f].type,
               .values = std::vector<double>(count * each),
               .place = fields_[f].place};
      runtime::parallel_for(executor_, count, [&](std::size_t i) {
        std::copy_n(&values[i * stride + first], each, &field.values[i * each]);
      });
      first += each;
    }
  }

  const Executor& executor_;
  std::span<const NamedField> fields_;
  const JoinParts& join_;
  const FixedMesh<Dim, Space> old_mesh_;
  FixedMesh<Dim, Space> new_mesh_;
  const AnyMesh& to_;
  const Locator<Dim, Space> locator_;
  TransferredFields result_;
};

template <int Dim, int Space = Dim>
TransferredFields transfer_in(const Executor& executor, const NamedFieldsOnMesh& from,
                              const AnyMesh& to, const std::vector<Carrying>& how_of,
                              const JoinParts& join) {
  if (Dim < Space && std::ranges::count(how_of, Carrying::conservatively) > 0) refuse_projection();
  expect_places(executor, from.mesh.coordinates, Space, "old vertex");
  expect_places(executor, to.coordinates, Space, "new vertex");
  FieldCarrier<Dim, Space> carrier(executor, from, to, join);
  for (const Where place : {Where::vertices, Where::elements})
    for (const Carrying carrying : {Carrying::by_value, Carrying::conservatively}) {
      std::vector<std::size_t> which;
      for (std::size_t f = 0; f < from.fields.size(); ++f)
        if (from.fields[f].place == place && how_of[f] == carrying) which.push_back(f);
      carrier.carry(which, place, carrying);
    }
  return carrier.take_result();
}

}  // namespace

TransferredFields transfer_fields(const Executor& executor, const NamedFieldsOnMesh& from,
                                  const AnyMesh& to, const std::vector<Carrying>& carrying,
                                  const JoinParts& join) {
  expect_coordinates(from.mesh);
  expect_coordinates(to);
  std::vector<Carrying> how_of = carrying;
  if (carrying.size() == 1) how_of.assign(from.fields.size(), carrying[0]);
  if (how_of.size() != from.fields.size())
    throw InputError("carrying: expected one entry, or one for each of the " +
                     std::to_string(from.fields.size()) + " fields, found " +
                     std::to_string(carrying.size()));
  for (std::size_t f = 0; f < from.fields.size(); ++f) expect_field(executor, from, f, how_of[f]);
  if (is_surface(from.mesh)) return transfer_in<2, 3>(executor, from, to, how_of, join);
  return from.mesh.dimension == 2 ? transfer_in<2>(executor, from, to, how_of, join)
                                  : transfer_in<3>(executor, from, to, how_of, join);
}

}  // namespace ductile::meshadapt
