#include "shown_field.hpp"

#include <cmath>
#include <cstddef>
#include <string_view>

#include "io/number_in.hpp"

namespace ductile::cli {

namespace {

/// A number from 1; 0 if the word is none.
std::size_t place_in_list(std::string_view word) {
  return number_in<std::size_t>(word).value_or(0);
}

const NamedField* find(std::string_view word, const std::vector<NamedField>& fields) {
  for (const NamedField& field : fields)
    if (field.name == word) return &field;
  const std::size_t number = place_in_list(word);
  return number >= 1 && number <= fields.size() ? &fields[number - 1] : nullptr;
}

/// The number of times that component i occurs in a tensor.
double weight_of(AnyField::Type type, std::size_t i) {
  const bool diagonal = i == 0 || i == 2 || i == 5;  // of a symmetric one
  return type == AnyField::Type::symmetric && !diagonal ? 2 : 1;
}

[[noreturn]] void refuse(const std::string& by, const std::vector<NamedField>& fields,
                         const std::string& where) {
  std::string list;
  for (std::size_t i = 0; i < fields.size(); ++i)
    list += (i == 0 ? "" : ", ") + std::to_string(i + 1) + " " + fields[i].name;
  throw UsageError(
      "option --by: expected quality, size, reference, metric or a field, by name or "
      "number, found '" +
      by + "'; " + where + (list.empty() ? " has no fields, -sol gives others" : " has " + list));
}

}  // namespace

NamedField shown_field(const std::string& by, const std::vector<NamedField>& fields, int dimension,
                       const std::string& where) {
  const NamedField* field = find(by, fields);
  std::size_t component = 0;
  const std::size_t colon = by.rfind(':');
  if (!field && colon != std::string::npos) {
    field = find(by.substr(0, colon), fields);
    component = place_in_list(by.substr(colon + 1));
    if (component == 0) field = nullptr;
  }
  if (!field) refuse(by, fields, where);
  const auto count = static_cast<std::size_t>(component_count(field->type, dimension));
  if (component > count)
    throw UsageError("option --by: expected a component from 1 to " + std::to_string(count) +
                     " of '" + field->name + "', found " + std::to_string(component));
  NamedField shown{field->name, AnyField::Type::scalar, {}, field->place};
  if (component > 0)
    shown.name += ":" + std::to_string(component);
  else if (count > 1)
    shown.name += field->type == AnyField::Type::vector ? " (length)" : " (norm)";
  for (std::size_t at = 0; at < field->values.size(); at += count) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i)
      sum = std::hypot(sum, std::sqrt(weight_of(field->type, i)) * field->values[at + i]);
    shown.values.push_back(component > 0 ? field->values[at + component - 1]
                           : count > 1   ? sum
                                         : field->values[at]);
  }
  return shown;
}

}  // namespace ductile::cli
