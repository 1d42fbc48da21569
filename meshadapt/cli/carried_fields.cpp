#include "carried_fields.hpp"

#include <algorithm>
#include <utility>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "files.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;
using meshadapt::AnyField;

/// Splits a field into those of each file, in the order of files.
std::vector<AnyField> apart(const AnyField& all, const std::vector<std::size_t>& field_count_of) {
  std::vector<AnyField> parts;
  std::size_t field = 0, offset = 0;
  const std::size_t stride = stride_of(all);
  for (const std::size_t count : field_count_of) {
    AnyField part{all.dimension, all.vertex_count, {}, {}, all.name};
    const auto first = all.types.begin() + static_cast<std::ptrdiff_t>(field);
    part.types.assign(first, first + static_cast<std::ptrdiff_t>(count));
    const std::size_t width = stride_of(part);
    part.values.resize(width * part.vertex_count);
    for (std::size_t v = 0; v < part.vertex_count; ++v)
      std::copy_n(&all.values[v * stride + offset], width, &part.values[v * width]);
    field += count;
    offset += width;
    parts.push_back(std::move(part));
  }
  return parts;
}

/// A name that no field before has: with that of the file in front if the name is taken.
std::string other_name(std::string name, const std::string& file,
                       const std::vector<std::string>& taken) {
  while (std::find(taken.begin(), taken.end(), name) != taken.end()) name.insert(0, file + "_");
  return name;
}

}  // namespace

CarriedFields::CarriedFields(const Arguments& arguments, const fs::path& output)
    : interpolate_(arguments.has("--interpolate")) {
  for (const std::string& name : arguments.texts("--field")) inputs_.emplace_back(name);
  if (interpolate_ && inputs_.empty())
    throw UsageError("option --interpolate: expected --field as well");
  if (holds_fields(output)) return;  // which they then go into
  const std::string ending = field_beside(output).extension().string();
  for (const fs::path& input : inputs_) {
    const fs::path place =
        field_beside(output).replace_extension("." + input.stem().string() + ending);
    const auto same = std::find(outputs_.begin(), outputs_.end(), place);
    if (same != outputs_.end())
      throw UsageError("options --field: " +
                       inputs_[static_cast<std::size_t>(same - outputs_.begin())].string() +
                       " and " + input.string() + " would both be written to " + place.string() +
                       "; give one of them another name");
    outputs_.push_back(place);
  }
}

CarriedFields::Values CarriedFields::read(const meshadapt::AnyMesh& mesh,
                                          meshadapt::Warnings& warnings,
                                          std::vector<std::string> taken) const {
  Values values;
  for (const fs::path& input : inputs_) {
    const auto fields = read_solutions(input, mesh, warnings);
    AnyField all = side_by_side(fields, mesh);
    all.name = input.string();
    values.field_count_of.push_back(fields.size());
    values.all =
        values.field_count_of.size() == 1 ? std::move(all) : meshadapt::joined(values.all, all);
    for (const meshadapt::NamedField& field : fields) {
      values.names.push_back(other_name(field.name, as_utf8(input.stem().string()), taken));
      taken.push_back(values.names.back());
    }
  }
  return values;
}

std::vector<AnyField> CarriedFields::carry(const runtime::Executor& executor,
                                           const meshadapt::AnyMesh& from, const Values& values,
                                           const meshadapt::AnyMesh& to) const {
  if (inputs_.empty()) return {};
  const meshadapt::FieldOnMesh old{from, values.all};
  return apart(interpolate_ ? meshadapt::interpolate_field(executor, old, to).field
                            : meshadapt::project_field(executor, old, to).field,
               values.field_count_of);
}

void CarriedFields::write(meshadapt::AtomicOutputs& outputs,
                          const std::vector<AnyField>& carried) const {
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    meshadapt::write_field(outputs, outputs_[i], carried[i]);
}

std::vector<meshadapt::NamedField> CarriedFields::named_fields(
    const std::vector<AnyField>& carried, const std::vector<std::string>& names) {
  std::vector<meshadapt::NamedField> all;
  for (const AnyField& fields : carried)
    for (auto& field : meshadapt::named_fields(fields, "field")) {
      field.name = names.at(all.size());
      all.push_back(std::move(field));
    }
  return all;
}

}  // namespace ductile::cli
