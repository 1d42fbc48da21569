#include "ductile/meshadapt/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
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
  FieldCarrier(const Executor& executor, const AnyMesh& from, const AnyMesh& to,
               const JoinParts& join)
      : executor_(executor),
        join_(join),
        old_mesh_(make_fixed_mesh<Dim, Space>(executor, from)),
        new_mesh_(make_fixed_mesh<Dim, Space>(executor, to)),
        to_(to),
        locator_(executor, old_mesh_) {
    if (join_) join_(new_mesh_.share_of, 1, Joining::sum);
  }

  /// Values on the new mesh. Adds to the report.
  std::vector<double> carried(const Components& field, Where place, Carrying carrying,
                              const ProjectionOptions& projection = {}) {
    Coverage coverage;
    std::vector<double> values;
    if (place == Where::elements) {
      const ElementFields<Dim, Space> fields(executor_, locator_, field, new_mesh_);
      if (carrying == Carrying::by_value) return fields.at_centroids();
      if constexpr (Dim == Space) values = fields.means(coverage);
    } else {
      Evaluated at_vertices = evaluate_at_vertices(executor_, locator_, field, to_);
      report_.vertices_outside = at_vertices.outside;
      if (carrying == Carrying::by_value) {
        if (join_) join_(at_vertices.values, field.stride, Joining::first);
        return std::move(at_vertices.values);
      }
      if constexpr (Dim == Space) {
        ConservativeTransfer<Dim> onto(executor_, locator_, field, new_mesh_, join_);
        values = onto.run(projection);
        coverage = onto.coverage();
      }
    }
    report_.volume_outside = coverage.volume_outside;
    report_.volume_left_out = coverage.volume_left_out;
    return values;
  }

  const TransferReport& report() const { return report_; }

 private:
  const Executor& executor_;
  const JoinParts& join_;
  const FixedMesh<Dim, Space> old_mesh_;
  FixedMesh<Dim, Space> new_mesh_;
  const AnyMesh& to_;
  const Locator<Dim, Space> locator_;
  TransferReport report_;
};

void expect_both_places(const Executor& executor, const AnyMesh& from, const AnyMesh& to) {
  expect_places(executor, from.coordinates, from.dimension, "old vertex");
  expect_places(executor, to.coordinates, from.dimension, "new vertex");
}

// ---- Named fields: those on the same entities with the same method go together, because locating
// entities takes longer than copying values ----

/// Interleaves all components of each entity of the fields with these indices.
std::vector<double> side_by_side(const Executor& executor, const NamedFieldsOnMesh& from,
                                 const std::vector<std::size_t>& which, std::size_t stride) {
  const int dimension = from.mesh.dimension;
  const std::size_t count =
      from.fields[which[0]].values.size() / components(from.fields[which[0]], dimension);
  std::vector<double> values(count * stride);
  std::size_t first = 0;
  for (const std::size_t f : which) {
    const std::size_t each = components(from.fields[f], dimension);
    runtime::parallel_for(executor, count, [&](std::size_t i) {
      std::copy_n(&from.fields[f].values[i * each], each, &values[i * stride + first]);
    });
    first += each;
  }
  return values;
}

/// A field like this one, which has `each` components of all of them, from `first` on.
NamedField taken_out(const Executor& executor, const NamedField& like, std::size_t each,
                     std::size_t first, const Components& all) {
  const std::size_t count = all.values.size() / all.stride;
  NamedField field{like.name, like.type, std::vector<double>(count * each), like.place};
  runtime::parallel_for(executor, count, [&](std::size_t i) {
    std::copy_n(&all.values[i * all.stride + first], each, &field.values[i * each]);
  });
  return field;
}

template <int Dim, int Space = Dim>
TransferredFields transfer_in(const Executor& executor, const NamedFieldsOnMesh& from,
                              const AnyMesh& to, const std::vector<Carrying>& how_of,
                              const JoinParts& join) {
  if (Dim < Space && std::ranges::count(how_of, Carrying::conservatively) > 0) refuse_projection();
  expect_both_places(executor, from.mesh, to);
  FieldCarrier<Dim, Space> carrier(executor, from.mesh, to, join);
  TransferredFields result;
  result.fields.resize(from.fields.size());
  for (const Where place : {Where::vertices, Where::elements})
    for (const Carrying carrying : {Carrying::by_value, Carrying::conservatively}) {
      std::vector<std::size_t> which;
      std::size_t stride = 0, first = 0;
      for (std::size_t f = 0; f < from.fields.size(); ++f)
        if (from.fields[f].place == place && how_of[f] == carrying) {
          which.push_back(f);
          stride += components(from.fields[f], Space);
        }
      if (which.empty()) continue;
      const std::vector<double> values = side_by_side(executor, from, which, stride);
      const std::vector<double> carried = carrier.carried({values, stride}, place, carrying);
      for (const std::size_t f : which) {
        const std::size_t each = components(from.fields[f], Space);
        result.fields[f] = taken_out(executor, from.fields[f], each, first, {carried, stride});
        result.fields[f].whole =
            place == Where::elements && carrying == Carrying::by_value && from.fields[f].whole;
        first += each;
      }
    }
  result.report = carrier.report();
  return result;
}

// ---- One field at the vertices ----

template <int Dim, int Space = Dim>
TransferredField transfer(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                          const ProjectionOptions* projection) {
  if (Dim < Space && projection) refuse_projection();
  expect_both_places(executor, from.mesh, to);
  const JoinParts whole;
  FieldCarrier<Dim, Space> carrier(executor, from.mesh, to, whole);
  TransferredField result;
  result.field = {Space, to.vertex_count(), from.field.types, {}, from.field.name};
  result.field.values = carrier.carried({from.field.values, stride_of(from.field)}, Where::vertices,
                                        projection ? Carrying::conservatively : Carrying::by_value,
                                        projection ? *projection : ProjectionOptions{});
  result.report = carrier.report();
  return result;
}

void expect_points(const Executor& executor, std::span<const double> coordinates, int dimension) {
  if (coordinates.size() % static_cast<std::size_t>(dimension) != 0)
    throw InputError("expected " + std::to_string(dimension) +
                     " coordinates for each point, found " + std::to_string(coordinates.size()) +
                     " in all");
  expect_places(executor, coordinates, dimension, "point");
}

template <int Dim, int Space = Dim>
TransferredField sample(const Executor& executor, const FieldOnMesh& from,
                        std::span<const double> coordinates) {
  expect_places(executor, from.mesh.coordinates, Space, "vertex");
  const auto mesh = make_fixed_mesh<Dim, Space>(executor, from.mesh);
  expect_points(executor, coordinates, Space);
  const Locator<Dim, Space> locator(executor, mesh);
  const Components field{from.field.values, stride_of(from.field)};
  TransferredField result;
  result.field = {Space, coordinates.size() / Space, from.field.types, {}, from.field.name};
  auto at_points = evaluate_at(executor, locator, field, coordinates);
  result.field.values = std::move(at_points.values);
  result.report.vertices_outside = at_points.outside;
  return result;
}

TransferredField transfer_any(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                              const ProjectionOptions* projection) {
  expect_field_of(from.field, from.mesh);
  if (is_surface(from.mesh)) return transfer<2, 3>(executor, from, to, projection);
  return from.mesh.dimension == 2 ? transfer<2>(executor, from, to, projection)
                                  : transfer<3>(executor, from, to, projection);
}

}  // namespace

TransferredField interpolate_field(const Executor& executor, const FieldOnMesh& from,
                                   const AnyMesh& to) {
  return transfer_any(executor, from, to, nullptr);
}

TransferredField interpolate_at(const Executor& executor, const FieldOnMesh& from,
                                std::span<const double> coordinates) {
  expect_field_of(from.field, from.mesh);
  if (is_surface(from.mesh)) return sample<2, 3>(executor, from, coordinates);
  return from.mesh.dimension == 2 ? sample<2>(executor, from, coordinates)
                                  : sample<3>(executor, from, coordinates);
}

TransferredField project_field(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                               const ProjectionOptions& options) {
  expect_finite(executor, from.field);
  return transfer_any(executor, from, to, &options);
}

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
