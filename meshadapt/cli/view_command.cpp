#include <array>
#include <filesystem>
#include <string>

#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "files.hpp"
#include "picture/draw.hpp"
#include "run_in_team.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::array<Option, 6> options{{
    {"-o", "PICTURE", "where the picture goes: a name ending in .png or .svg (default NAME.png)",
     "--output"},
    {"-sol", "METRIC", "measures quality in this metric (.sol, .solb)"},
    {"--by", "WHAT", "colours elements by quality (default), size or reference"},
    {"--cut", "AXIS", "3D: cuts at the middle of x, y or z (default: where it is thinnest)"},
    {"--size", "PX", "pixels along the larger side of each drawing (default 1000)"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
}};

Tint tint_of(const Arguments& arguments) {
  const std::string by = arguments.text("--by").value_or("quality");
  if (by == "quality") return Tint::quality;
  if (by == "size") return Tint::size;
  if (by == "reference") return Tint::reference;
  throw UsageError("option --by: expected quality, size or reference, found '" + by + "'");
}

int axis_of(const Arguments& arguments) {
  const std::optional<std::string> axis = arguments.text("--cut");
  if (!axis) return -1;
  const std::size_t index = std::string("xyz").find(*axis);
  if (axis->size() != 1 || index == std::string::npos)
    throw UsageError("option --cut: expected x, y or z, found '" + *axis + "'");
  return static_cast<int>(index);
}

PictureFormat format_of(const fs::path& picture) {
  if (picture.extension() == ".png") return PictureFormat::png;
  if (picture.extension() == ".svg") return PictureFormat::svg;
  throw UsageError(picture.string() + ": expected a name ending in .png or .svg");
}

int run(const Arguments& arguments) {
  if (arguments.operands().size() != 1)
    throw UsageError("expected one mesh, found " + std::to_string(arguments.operands().size()));
  const fs::path input = input_of(arguments.operands()[0]);
  fs::path picture = arguments.text("-o").value_or("");
  if (picture.empty()) picture = fs::path(input).replace_extension(".png");
  const PictureFormat format = format_of(picture);
  const SceneOptions options_of_scene{.tint = tint_of(arguments), .cut_axis = axis_of(arguments)};
  const int size = arguments.integer("--size", 50, 8000).value_or(1000);
  meshadapt::check_writable(picture);

  const int threads = arguments.integer("--threads", 1, 4096).value_or(0);
  return run_in_team({.threads = threads}, [&](const runtime::Executor& executor) {
    meshadapt::Warnings warnings;
    const meshadapt::AnyMesh mesh = meshadapt::read_mesh(input, &warnings);
    std::optional<meshadapt::AnyField> metric;
    if (const auto path = arguments.text("-sol")) metric = read_metric(*path, mesh, warnings);
    const Scene scene = make_scene(executor, mesh, metric ? &*metric : nullptr, options_of_scene);
    const std::string bytes = draw(scene, format, size);
    meshadapt::AtomicOutputs outputs;
    outputs.stage(picture).write(bytes);
    outputs.commit();
    print_warnings(warnings);
    return done;
  });
}

}  // namespace

const Command view_command{
    "view",
    "MESH [-o PICTURE.png|.svg]",
    "draws a mesh",
    "2D: the triangles. 3D: the surface by reference, and a cut through the middle.",
    options,
    run};

}  // namespace ductile::cli
