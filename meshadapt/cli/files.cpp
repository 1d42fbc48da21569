#include "files.hpp"

#include <algorithm>
#include <cstdio>
#include <system_error>

#include "ductile/meshadapt/gmf.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace ductile::cli {

namespace fs = std::filesystem;

void print_warnings(const meshadapt::Warnings& warnings, int verbosity) {
  if (verbosity <= 0) return;
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "ductile: warning: %s\n", warning.c_str());
}

std::optional<fs::path> metric_beside(const fs::path& mesh) {
  for (const char* ending : {".sol", ".solb"}) {
    fs::path candidate = mesh;
    candidate.replace_extension(ending);
    std::error_code ignored;
    if (candidate != mesh && fs::exists(candidate, ignored)) return candidate;
  }
  return std::nullopt;
}

fs::path default_output(const fs::path& mesh) {
  fs::path output = mesh;
  return output.replace_extension(mesh.extension() == ".meshb" ? ".o.meshb" : ".o.mesh");
}

fs::path field_beside(const fs::path& mesh) {
  fs::path output = mesh;
  return output.replace_extension(mesh.extension() == ".meshb" ? ".solb" : ".sol");
}

meshadapt::AnyField read_metric(const fs::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings) {
  return meshadapt::metric_of(meshadapt::read_field(path, &warnings), mesh);
}

meshadapt::AnyField read_fields(const fs::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings) {
  using Type = meshadapt::AnyField::Type;
  meshadapt::AnyField field = meshadapt::read_field(path, &warnings);
  if (std::all_of(field.types.begin(), field.types.end(), [](Type t) { return t == Type::scalar; }))
    field.dimension = mesh.dimension;  // which may be 2 in a file of dimension 3 that is flat
  meshadapt::expect_field_of(field, mesh);
  return field;
}

std::string with_commas(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

}  // namespace ductile::cli
