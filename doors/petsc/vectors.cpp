#include "vectors.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "distributed/adapt_part.hpp"
#include "distributed/transfer_parts.hpp"

namespace ductile::petsc {

namespace {

using meshadapt::Carrying;
using meshadapt::InputError;
using meshadapt::NamedField;
using Place = NamedField::Place;

PlexPart read_parts(const Communicator& comm, const runtime::Executor& executor, DM dm) {
  PlexPart read = read_plex(comm, dm, {});
  comm.on_all([&] { list_boundary(executor, read.part); });
  return read;
}

/// The entities of a part, counted from the first of their kind in the DMPlex.
const std::vector<PetscInt>& entities(const PlexPart& part, Place place) {
  return place == Place::vertices ? part.point_of : part.cell_of;
}

PetscInt count_of(DM dm, Place place) {
  return (place == Place::vertices ? vertices_of(dm) : stratum_of_height(dm, 0)).size();
}

/// Number of values per entity, the same on all ranks. Throws if a vector has the wrong length.
PetscInt components(const Communicator& comm, DM dm, const CarriedVector& vector) {
  PetscInt length = 0;
  check(VecGetLocalSize(vector.values, &length));
  const PetscInt count = count_of(dm, vector.place);
  const auto each = static_cast<PetscInt>(comm.largest(count > 0 ? length / count : 0));
  comm.on_all([&] {
    if (each > 0 && length == each * count) return;
    throw InputError("vector " + vector.name + ": expected a local vector with as many values for" +
                     " each of " + std::to_string(count) +
                     (vector.place == Place::vertices ? " vertices" : " cells") + ", found " +
                     std::to_string(length));
  });
  return each;
}

/// Appends a scalar field for each component.
void append_fields(std::vector<NamedField>& fields, const PlexPart& part,
                   const CarriedVector& vector, PetscInt each) {
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(vector.values, &values));
  for (PetscInt k = 0; k < each; ++k) {
    NamedField field{vector.name, meshadapt::AnyField::Type::scalar, {}, vector.place};
    for (const PetscInt entity : entities(part, vector.place))
      field.values.push_back(PetscRealPart(values[entity * each + k]));
    fields.push_back(std::move(field));
  }
  check(VecRestoreArrayRead(vector.values, &values));
}

/// Makes a local vector with `each` values per entity; value(entity, component).
template <class Value>
Vec local_vector(std::size_t count, PetscInt each, Value&& value) {
  Vec vector = nullptr;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(count) * each, &vector));
  check(VecSetBlockSize(vector, each));
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(vector, &values));
  for (std::size_t i = 0; i < count; ++i)
    for (PetscInt k = 0; k < each; ++k)
      values[static_cast<PetscInt>(i) * each + k] = value(i, static_cast<std::size_t>(k));
  check(VecRestoreArrayWrite(vector, &values));
  return vector;
}

std::vector<std::string> names_in(DM dm, const char* option) {
  const char* prefix = nullptr;
  check(PetscObjectGetOptionsPrefix(reinterpret_cast<PetscObject>(dm), &prefix));
  std::array<char*, 64> texts{};
  auto count = static_cast<PetscInt>(texts.size());
  check(PetscOptionsGetStringArray(nullptr, prefix, option, texts.data(), &count, nullptr));
  std::vector<std::string> names;
  for (PetscInt i = 0; i < count; ++i) {
    names.emplace_back(texts[static_cast<std::size_t>(i)]);
    check(PetscFree(texts[static_cast<std::size_t>(i)]));
  }
  return names;
}

std::vector<CarriedVector> composed(DM dm) {
  const auto by_value = names_in(dm, "-dm_ductile_by_value");
  std::vector<CarriedVector> vectors;
  const auto add = [&](const char* option, Place place) {
    for (const std::string& name : names_in(dm, option)) {
      PetscObject object = nullptr;
      check(PetscObjectQuery(reinterpret_cast<PetscObject>(dm), name.c_str(), &object));
      if (object == nullptr)
        throw InputError(std::string("option ") + option + ": no vector '" + name +
                         "' is composed with the mesh");
      const bool as_it_is = std::find(by_value.begin(), by_value.end(), name) != by_value.end();
      vectors.push_back({name, reinterpret_cast<Vec>(object), place,
                         as_it_is ? Carrying::by_value : Carrying::conservatively});
    }
  };
  add("-dm_ductile_fields", Place::vertices);
  add("-dm_ductile_cell_fields", Place::elements);
  return vectors;
}

void compose(DM dm, const std::string& name, Vec vector) {
  check(PetscObjectCompose(reinterpret_cast<PetscObject>(dm), name.c_str(),
                           reinterpret_cast<PetscObject>(vector)));
  check(VecDestroy(&vector));  // the mesh keeps a reference
}

/// The adapted metric as a vector. PETSc sorts the vertices of a rank by number.
Vec metric_vector(const Part& part) {
  const std::vector<VertexId> order = by_number(part);
  const auto dim = static_cast<std::size_t>(part.mesh.dimension);
  const std::size_t width = dim * (dim + 1) / 2;
  return local_vector(order.size(), part.mesh.dimension * part.mesh.dimension,
                      [&](std::size_t i, std::size_t k) {
                        const std::size_t low = std::min(k / dim, k % dim);
                        const std::size_t high = std::max(k / dim, k % dim);
                        return part.wanted.values[order[i] * width + high * (high + 1) / 2 + low];
                      });
}

}  // namespace

std::vector<Vec> carry_vectors(const Communicator& comm, const runtime::Executor& executor,
                               DM before, const std::vector<CarriedVector>& vectors, DM after) {
  const PlexPart from = read_parts(comm, executor, before);
  const PlexPart to = read_parts(comm, executor, after);
  comm.on_all([&] {
    if (static_cast<PetscInt>(to.cell_of.size()) != count_of(after, Place::elements))
      throw InputError("expected a mesh without an overlap to carry fields to");
  });
  std::vector<NamedField> fields;
  std::vector<Carrying> carrying;
  std::vector<PetscInt> each_of;
  for (const CarriedVector& vector : vectors) {
    each_of.push_back(components(comm, before, vector));
    comm.on_all([&] {
      append_fields(fields, from, vector, each_of.back());
      carrying.resize(fields.size(), vector.carrying);
    });
  }
  fields = transfer_parts(comm, executor, {from.part, fields}, to.part, carrying);
  return comm.on_all([&] {
    std::vector<Vec> carried;
    std::size_t first = 0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      const auto& points = entities(to, vectors[i].place);
      std::vector<std::size_t> at(points.size());  // [entity of the DMPlex], its index in the part
      for (std::size_t p = 0; p < points.size(); ++p) at[static_cast<std::size_t>(points[p])] = p;
      carried.push_back(local_vector(at.size(), each_of[i], [&](std::size_t e, std::size_t k) {
        return fields[first + k].values[at[e]];
      }));
      first += static_cast<std::size_t>(each_of[i]);
    }
    return carried;
  });
}

void compose_vectors(const Communicator& comm, const runtime::Executor& executor, DM before,
                     const AdaptedParts& parts, DM after) {
  compose(after, "ductile_metric", comm.on_all([&] { return metric_vector(parts.part); }));
  const std::vector<CarriedVector> vectors = comm.on_all([&] { return composed(before); });
  if (vectors.empty()) return;
  const std::vector<Vec> carried = carry_vectors(comm, executor, before, vectors, after);
  for (std::size_t i = 0; i < vectors.size(); ++i) compose(after, vectors[i].name, carried[i]);
}

}  // namespace ductile::petsc
