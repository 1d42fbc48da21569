#include "carried_fields.hpp"

#include <algorithm>
#include <utility>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "files.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;

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
                                          meshadapt::Warnings& warnings) const {
  Values values;
  std::vector<std::string> taken = {"metric"};
  for (const fs::path& input : inputs_) {
    auto fields = read_solutions(input, mesh, warnings);
    values.count_of.push_back(fields.size());
    for (meshadapt::NamedField& field : fields) {
      field.name = other_name(field.name, as_utf8(input.stem().string()), taken);
      taken.push_back(field.name);
      values.fields.push_back(std::move(field));
    }
  }
  return values;
}

std::vector<meshadapt::NamedField> CarriedFields::carry(const runtime::Executor& executor,
                                                        const meshadapt::AnyMesh& from,
                                                        const Values& values,
                                                        const meshadapt::AnyMesh& to) const {
  if (inputs_.empty()) return {};
  using meshadapt::Carrying;
  const bool by_value = interpolate_ || meshadapt::is_surface(from);
  const Carrying way = by_value ? Carrying::by_value : Carrying::conservatively;
  return meshadapt::transfer_fields(executor, {from, values.fields}, to, {way}).fields;
}

void CarriedFields::write(meshadapt::AtomicOutputs& outputs, const meshadapt::AnyMesh& mesh,
                          const std::vector<meshadapt::NamedField>& carried,
                          const std::vector<std::size_t>& count_of) const {
  auto next = carried.begin();
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const auto first = std::exchange(next, next + static_cast<std::ptrdiff_t>(count_of[i]));
    meshadapt::write_field(outputs, outputs_[i], side_by_side({first, next}, mesh));
  }
}

}  // namespace ductile::cli
