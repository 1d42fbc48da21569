#include "move/cargo.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

namespace {

using Place = NamedField::Place;

/// Volumes of elements, or the integrals of the hat functions of vertices.
template <int Dim>
const std::vector<double>& weights(const FixedMesh<Dim>& mesh, Place place) {
  return place == Place::vertices ? mesh.share_of : mesh.volume_of;
}

/// Turns the components of a vector or a tensor.
template <int Dim>
void turn_components(double* values, AnyField::Type type, const Rotation<Dim>& rotation) {
  const auto turn_each = [&](std::size_t first, std::size_t stride) {
    Vector<Dim> vector;
    for (std::size_t i = 0; i < Dim; ++i) vector.x[i] = values[first + i * stride];
    vector = rotation.turned(vector);
    for (std::size_t i = 0; i < Dim; ++i) values[first + i * stride] = vector.x[i];
  };
  if (type == AnyField::Type::vector) turn_each(0, 1);
  for (std::size_t i = 0; type == AnyField::Type::matrix && i < Dim; ++i) turn_each(i * Dim, 1);
  for (std::size_t i = 0; type == AnyField::Type::matrix && i < Dim; ++i) turn_each(i, Dim);
  if (type != AnyField::Type::symmetric) return;
  Metric<Dim> tensor;
  std::copy_n(values, tensor.m.size(), tensor.m.begin());
  tensor = rotation.turned(tensor);
  std::copy_n(tensor.m.begin(), tensor.m.size(), values);
}

}  // namespace

template <int Dim>
Cargo<Dim>::Cargo(const runtime::Executor& executor, const AnyMesh& mesh,
                  const MoveOptions& options)
    : executor_(executor),
      fields_(options.fields.begin(), options.fields.end()),
      carrying_(options.carrying) {
  if (carrying_.size() == 1) carrying_.assign(fields_.size(), options.carrying[0]);
  if (carrying_.size() != fields_.size())
    throw InputError("carrying: expected one entry, or one for each of the " +
                     std::to_string(fields_.size()) + " fields, found " +
                     std::to_string(options.carrying.size()));
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const NamedField& field = fields_[f];
    const bool at_vertices = field.place == Place::vertices;
    const std::size_t expected =
        components(f) * (at_vertices ? mesh.vertex_count() : elements_in<Dim>(mesh).size());
    const std::string name = "field '" + field.name + "': ";
    if (field.values.size() != expected)
      throw InputError(name + "expected " + std::to_string(expected) + " values, found " +
                       std::to_string(field.values.size()));
    if (keeps_content(f) &&
        !std::ranges::all_of(field.values, [](double x) { return std::isfinite(x); }))
      throw InputError(
          name + "expected finite values because its integral is kept, found one that is not");
  }
  is_turned_.resize(fields_.size(), 0);
  for (const std::string& name : options.turned) {
    const auto at = std::ranges::find(fields_, name, &NamedField::name);
    if (at == fields_.end() || at->type == AnyField::Type::scalar)
      throw InputError(
          "turned: expected names of fields of vectors or tensors that go along, found '" + name +
          "'");
    is_turned_[static_cast<std::size_t>(at - fields_.begin())] = 1;
  }
}

template <int Dim>
bool Cargo<Dim>::has_turned() const {
  return std::ranges::find(is_turned_, 1) != is_turned_.end();
}

template <int Dim>
bool Cargo<Dim>::keeps_content(std::size_t field) const {
  return carrying_[field] == Carrying::conservatively;
}

template <int Dim>
std::size_t Cargo<Dim>::components(std::size_t field) const {
  return static_cast<std::size_t>(component_count(fields_[field].type, Dim));
}

template <int Dim>
void Cargo<Dim>::turn(Place place, const std::vector<Rotation<Dim>>& rotation_of) {
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (!is_turned_[f] || fields_[f].place != place) continue;
    const std::size_t n = components(f);
    runtime::parallel_for(executor_, rotation_of.size(), [&](std::size_t i) {
      turn_components(&fields_[f].values[i * n], fields_[f].type, rotation_of[i]);
    });
  }
}

template <int Dim>
void Cargo<Dim>::follow(const FixedMesh<Dim>& before, const FixedMesh<Dim>& after) {
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (!keeps_content(f)) continue;
    const std::vector<double>& was = weights(before, fields_[f].place);
    const std::vector<double>& is = weights(after, fields_[f].place);
    const std::size_t n = components(f);
    runtime::parallel_for(executor_, was.size(), [&](std::size_t i) {
      if (was[i] == is[i]) return;
      for (std::size_t k = 0; k < n; ++k) fields_[f].values[i * n + k] *= was[i] / is[i];
    });
  }
}

template <int Dim>
void Cargo<Dim>::replace(const FixedMesh<Dim>& before, const Part<Dim>& part,
                         const AnyMesh& adapted, const Renewals& renewals) {
  if (fields_.empty()) return;
  content_.assign(fields_.size(), {});
  for (std::size_t f = 0; f < fields_.size(); ++f)
    for (std::size_t k = 0; k < components(f) && keeps_content(f); ++k)
      content_[f].push_back(integral(f, k, before));
  std::vector<NamedField> old = fields_;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const std::size_t n = components(f);
    const auto& numbers = fields_[f].place == Place::vertices ? part.vertices() : part.elements();
    old[f].values.clear();
    for (const std::uint32_t i : numbers)
      old[f].values.insert(old[f].values.end(), &fields_[f].values[i * n],
                           &fields_[f].values[i * n] + n);
  }
  const auto carried = transfer_fields(executor_, {part.mesh(), old}, adapted, carrying_);
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const std::size_t n = components(f);
    const Renewal& renewal =
        fields_[f].place == Place::vertices ? renewals.vertices : renewals.elements;
    std::vector<double> values(renewal.size() * n);
    for (std::size_t i = 0; i < renewal.size(); ++i)
      std::copy_n(renewal.old_of[i] != none ? &fields_[f].values[renewal.old_of[i] * n]
                                            : &carried.fields[f].values[renewal.part_of[i] * n],
                  n, &values[i * n]);
    fields_[f].values = std::move(values);
  }
  std::vector<std::uint8_t> is_own(before.vertex_count(), 0);
  for (std::size_t v = 0; v < part.vertices().size(); ++v)
    is_own[part.vertices()[v]] = !part.is_shared(static_cast<VertexId>(v));
  vertices_.clear();
  elements_.clear();
  for (std::size_t v = 0; v < renewals.vertices.size(); ++v)
    if (renewals.vertices.old_of[v] == none || is_own[renewals.vertices.old_of[v]])
      vertices_.push_back(static_cast<std::uint32_t>(v));
  for (std::size_t e = 0; e < renewals.elements.size(); ++e)
    if (renewals.elements.old_of[e] == none) elements_.push_back(static_cast<std::uint32_t>(e));
}

template <int Dim>
void Cargo<Dim>::settle(const FixedMesh<Dim>& now) {
  for (std::size_t f = 0; f < fields_.size(); ++f)
    for (std::size_t k = 0; k < components(f) && keeps_content(f); ++k)
      spread(f, k, content_[f][k] - integral(f, k, now), now);
}

template <int Dim>
double Cargo<Dim>::integral(std::size_t field, std::size_t component,
                            const FixedMesh<Dim>& mesh) const {
  const std::vector<double>& weight = weights(mesh, fields_[field].place);
  const std::size_t n = components(field);
  return runtime::parallel_reduce(
      executor_, weight.size(), 0.0,
      [&](std::size_t i) { return weight[i] * fields_[field].values[i * n + component]; },
      std::plus<>());
}

/// Moves values towards the largest or the least of the part, all by the same share of the way, or
/// all by the same amount if that is not enough.
template <int Dim>
void Cargo<Dim>::spread(std::size_t field, std::size_t component, double amount,
                        const FixedMesh<Dim>& mesh) {
  const bool at_vertices = fields_[field].place == Place::vertices;
  const std::vector<std::uint32_t>& entities = at_vertices ? vertices_ : elements_;
  const std::vector<double>& weight = weights(mesh, fields_[field].place);
  const auto value = [&](std::uint32_t i) -> double& {
    return fields_[field].values[i * components(field) + component];
  };
  if (entities.empty() || amount == 0) return;
  double limit = value(entities[0]), whole = 0, room = 0;
  for (const std::uint32_t i : entities)
    limit = amount > 0 ? std::max(limit, value(i)) : std::min(limit, value(i));
  for (const std::uint32_t i : entities) {
    whole += weight[i];
    room += weight[i] * (limit - value(i));
  }
  const bool fits = std::abs(room) > std::abs(amount);
  for (const std::uint32_t i : entities)
    value(i) += fits ? amount / room * (limit - value(i)) : amount / whole;
}

template class Cargo<2>;
template class Cargo<3>;

}  // namespace ductile::meshadapt
