#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "files.hpp"
#include "picture/draw.hpp"
#include "shown_field.hpp"

namespace ductile::cli {

namespace {

constexpr std::array<Option, 6> options{{
    {"-o", "PICTURE",
     "where it goes: a .png, .svg, or .html to turn and cut it in a browser (default: NAME.png)",
     "--output"},
    {"-sol", "FILE", "the metric that quality is measured in, or to show; the fields of --by"},
    {"--by", "quality|size|reference|metric|FIELD",
     "what elements are coloured by (default: quality); metric draws its unit ellipses"},
    {"--cut", "x|y|z", "3D: the axis in the middle of which it is cut (default: the thinnest)"},
    {"--size", "PX", "pixels along the larger side of each drawing (default 1000)"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
}};

/// Any other word names a field.
Tint tint_of(const std::string& by) {
  return by == "quality"     ? Tint::quality
         : by == "size"      ? Tint::size
         : by == "reference" ? Tint::reference
         : by == "metric"    ? Tint::metric
                             : Tint::field;
}

int axis_of(const Arguments& arguments) {
  const std::optional<std::string> axis = arguments.text("--cut");
  if (!axis) return -1;
  const std::size_t index = std::string("xyz").find(*axis);
  if (axis->size() != 1 || index == std::string::npos)
    throw UsageError("option --cut: expected x, y or z, found '" + *axis + "'");
  return static_cast<int>(index);
}

/// None for a page.
std::optional<PictureFormat> format_of(const fs::path& picture, Tint tint) {
  if (picture.extension() == ".png") return PictureFormat::png;
  if (picture.extension() == ".svg") return PictureFormat::svg;
  if (picture.extension() != ".html")
    throw UsageError(picture.string() + ": expected a name ending in .png, .svg or .html");
  if (tint == Tint::metric)
    throw UsageError(picture.string() + ": ellipses of --by metric are drawn in a .png or .svg");
  return std::nullopt;
}

struct Job {
  fs::path input, picture;
  std::optional<fs::path> sol;
  std::string by;
  std::optional<PictureFormat> format;  ///< none: a page
  SceneOptions scene;
  int size = 1000;
};

Job read_job(const Arguments& arguments) {
  Job job;
  job.input = only_mesh(arguments);
  job.picture = arguments.text("-o").value_or("");
  if (job.picture.empty()) job.picture = fs::path(job.input).replace_extension(".png");
  job.sol = arguments.text("-sol");
  job.by = arguments.text("--by").value_or("quality");
  job.scene = {.tint = tint_of(job.by), .cut_axis = axis_of(arguments)};
  job.format = format_of(job.picture, job.scene.tint);
  job.size = arguments.integer("--size", 50, 8000).value_or(1000);
  check_writable(job.picture);
  return job;
}

/// The metric of -sol, in which quality is measured; to draw a metric, also the one in the file of
/// the mesh or beside it.
std::optional<AnyField> metric_of(const Job& job, const MeshWithFields& file, Warnings& warnings) {
  if (job.scene.tint == Tint::field) return std::nullopt;
  if (job.sol) return read_metric(*job.sol, file.mesh, warnings);
  if (job.scene.tint != Tint::metric) return std::nullopt;
  if (const auto metric = metric_in(file)) return metric_of(*metric, file.mesh);
  if (const auto beside = metric_beside(job.input))
    return read_metric(*beside, file.mesh, warnings);
  throw InputError(file.mesh.name +
                   ": expected a metric (-sol) or one beside it or in it, found none");
}

/// The field to show, from the file of -sol, otherwise from the mesh, otherwise from the file
/// beside it.
NamedField field_of(const Job& job, MeshWithFields& file, Warnings& warnings) {
  fs::path where = job.input;
  std::vector<NamedField> fields = std::move(file.fields);
  if (job.sol)
    where = *job.sol;
  else if (fields.empty())
    where = metric_beside(job.input).value_or(where);
  if (where != job.input) fields = read_named_fields(where, file.mesh, warnings);
  return shown_field(job.by, fields, file.mesh.dimension, where.string());
}

int work(const runtime::Executor& executor, const Job& job) {
  Warnings warnings;
  MeshWithFields file = read_mesh_with_fields(job.input, &warnings);
  const std::optional<AnyField> metric = metric_of(job, file, warnings);
  SceneOptions options_of_scene = job.scene;
  NamedField field;
  if (job.scene.tint == Tint::field) {
    field = field_of(job, file, warnings);
    options_of_scene.field = &field;
  }
  const AnyField* const shown = metric ? &*metric : nullptr;
  const std::string bytes =
      job.format
          ? draw(make_scene(executor, file.mesh, shown, options_of_scene), *job.format, job.size)
          : turning_page(executor, file.mesh, shown, options_of_scene);
  AtomicOutputs outputs;
  write_bytes(outputs, job.picture, bytes);
  outputs.commit();
  print_warnings(warnings);
  return done;
}

int run(const Arguments& arguments) {
  const Job job = read_job(arguments);
  return run_in_team({.threads = threads_of(arguments)},
                     [&](const runtime::Executor& executor) { return work(executor, job); });
}

}  // namespace

const Command view_command{
    "view",
    "MESH [-o PICTURE.png|.svg|.html]",
    "draws a mesh",
    "2D: the triangles. 3D: the surface, and a cut through the middle. A FIELD is one of FILE, "
    "else\n"
    "of MESH, else of NAME.sol beside it, by its name or number; of vectors and tensors the norm, "
    "or\n"
    "component K of FIELD:K. --by metric draws unit ellipses where there is room; in 3D, those in\n"
    "which the cut meets the unit ellipsoids.",
    options,
    run};

}  // namespace ductile::cli
