#include "mmg_options.hpp"

#include "report.hpp"

namespace ductile::cli {

namespace {

struct Refused {
  std::string_view name, instead;
};
constexpr std::array<Refused, 9> refused{{
    {"3dMedit", "Mmg's, not here: flat meshes of dimension 3 are read, and written in dimension 2"},
    {"nreg", "Mmg's, not here: normals are not smoothed"},
    {"nsd", "Mmg's, not here: the whole mesh is written"},
    {"optimLES", "Mmg's, not here: --thorough goes on for better shapes"},
    {"metric", "-sol METRIC gives it"},
    {"output", "-o OUT names it"},
    {"size", "ductile adapt has -hsiz X, and --near, --on and --inside"},
    {"xreg", "Mmg's, not here: vertices are not moved to smooth a surface"},
}};

}  // namespace

std::string_view instead_of_mmg_option(std::string_view name) {
  for (const Refused& option : refused)
    if (option.name == name) return option.instead;
  for (const Option& option : mmg_options)
    if (option.name.substr(1) == name) return "Mmg's: ductile adapt takes it and needs none";
  return {};
}

std::string unneeded_mmg_options(const Arguments& arguments) {
  std::vector<std::string> given;
  for (const Option& option : mmg_options)
    if (arguments.has(option.name)) given.emplace_back(option.name);
  if (arguments.has("-ar") && !arguments.has("-hausd"))
    given.emplace_back("-ar (without -hausd all edges stay)");
  for (const char* option : {"-isoref", "-rmc"})
    if (arguments.has(option) && !arguments.has("-ls") && !arguments.has("-lssurf"))
      given.push_back(std::string(option) + " (without -ls)");
  if (given.empty()) return {};
  std::string list = listed(given);
  if (arguments.has("-nr") && arguments.has("-hausd"))
    list += " (no edge that turns by less than 90 degrees stays)";
  return "Mmg's options that need not be given here: " + list;
}

}  // namespace ductile::cli
