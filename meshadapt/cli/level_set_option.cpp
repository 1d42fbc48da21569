#include "level_set_option.hpp"

#include <limits>

#include "files.hpp"

namespace ductile::cli {

std::optional<LevelSetOption> level_set_option(const Arguments& arguments) {
  constexpr double mmgs_share = 1e-5;
  const bool on_boundary = arguments.has("-lssurf");
  if (!arguments.has("-ls") && arguments.has("--keep-volume"))
    throw UsageError("option --keep-volume: expected -ls, which cuts the mesh, found none");
  if (!arguments.has("-ls") && !on_boundary) return std::nullopt;
  if (arguments.has("-ls") && on_boundary)
    throw UsageError("options -ls and -lssurf: expected one of them, found both");
  if (arguments.has("-geometry"))
    throw UsageError(
        "options -ls and -geometry: expected one of them, found both; with -hausd the interface is "
        "on the surface of the level set");
  const auto number_or = [&](const char* option, double otherwise) {
    return arguments.text(option).value_or("").empty() ? otherwise : *arguments.number(option);
  };
  LevelSetOption option;
  option.cut.level = number_or(on_boundary ? "-lssurf" : "-ls", 0);
  option.cut.boundary_only = on_boundary;
  option.cut.keep_volume = arguments.positive("--keep-volume");
  if (arguments.has("-rmc")) option.cut.least_component = number_or("-rmc", mmgs_share);
  if (!(option.cut.least_component >= 0 && option.cut.least_component < 1))
    refuse_value("-rmc", "a fraction of the volume, from 0 to below 1", *arguments.text("-rmc"));
  constexpr int most = std::numeric_limits<std::int32_t>::max();
  if (const auto reference = arguments.integer("-isoref", -most, most))
    option.cut.interface = *reference;
  option.values = arguments.text("-sol");
  return option;
}

AnyField read_level_set(const LevelSetOption& option, const MeshWithFields& file,
                        Warnings& warnings) {
  const std::string name = option.values.value_or(file.mesh.name);
  auto fields = option.values ? chosen_solutions({*option.values}, file, warnings) : file.fields;
  if (!option.values)
    std::erase_if(fields, [](const auto& f) { return !is_at_vertices(f) || f.name == "metric"; });
  if (fields.empty())
    throw InputError(name +
                     ": expected the values of the level set, found none in it or beside it; "
                     "give them with -sol");
  if (fields.size() != 1 || fields[0].type != AnyField::Type::scalar)
    throw InputError(name +
                     ": expected one number at each vertex, the values of the level set, "
                     "found " +
                     (fields.size() == 1 ? "other values" : names_of(fields)) +
                     "; give a file or a field with these alone (-sol)");
  return side_by_side(fields, file.mesh);
}

namespace {

std::string in_short(double value) { return format("%.6g", value); }

std::string list_of(const std::vector<std::int32_t>& references) {
  return references.empty() ? "none" : listed(references);
}

}  // namespace

CutInput cut_report(const LevelSetOption& option, const CutOptions& options,
                    const CutReport& report) {
  CutInput cut;
  cut.report = report;
  cut.where = option.values.value_or("its field") + " is " + in_short(report.level);
  cut.interface = options.interface;
  if (options.materials.empty()) {
    cut.minus = {options.minus};
    cut.plus = {options.plus};
  }
  for (const CutMaterial& material : options.materials) {
    if (!material.split) continue;
    cut.minus.push_back(material.minus);
    cut.plus.push_back(material.plus);
  }
  return cut;
}

std::string to_text(const CutInput& cut) {
  const CutReport& report = cut.report;
  const bool in_plane = cut.before.dimension == 2 || report.on_surface;
  std::string text = printable(cut.before.name + ": cut where " + cut.where) + ": " +
                     counted(report.cut_elements, "element", "elements") + " cut, " +
                     counted(report.moved_vertices, "vertex", "vertices") + " moved onto the " +
                     (in_plane ? "curve" : "surface");
  if (report.removed_components > 0)
    text += ", " + counted(report.removed_components, "small component", "small components") +
            " removed";
  text += "\n  references below: " + list_of(cut.minus) + " (" + (in_plane ? "area " : "volume ") +
          in_short(report.minus_volume) + "), above: " + list_of(cut.plus) +
          ", between: " + std::to_string(cut.interface) + " (" +
          counted(report.interface_facets, in_plane ? "edge" : "triangle",
                  in_plane ? "edges" : "triangles") +
          ")\n";
  return text;
}

Json to_json(const CutInput& cut) {
  const CutReport& report = cut.report;
  return json_object("where", cut.where, "level", report.level, "references_below",
                     json_list({cut.minus.begin(), cut.minus.end()}), "references_above",
                     json_list({cut.plus.begin(), cut.plus.end()}), "reference_between",
                     cut.interface, "volume_below", report.minus_volume, "facets_between",
                     report.interface_facets, "cut_elements", report.cut_elements, "moved_vertices",
                     report.moved_vertices, "removed_components", report.removed_components,
                     "removed_volume", report.removed_volume);
}

}  // namespace ductile::cli
