#include "local_parameters.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "ductile/meshadapt/sizes.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;
using meshadapt::AnyMesh;
using meshadapt::LocalSize;
using meshadapt::Warnings;

std::optional<fs::path> file_beside(const AnyMesh& mesh) {
  const std::string ending = mesh.dimension == 2 ? ".mmg2d" : ".mmg3d";
  std::error_code ignored;
  for (fs::path path :
       {fs::path(mesh.name).replace_extension(ending), fs::path("DEFAULT" + ending)})
    if (fs::is_regular_file(path, ignored)) return path;
  return std::nullopt;
}

/// Mmg looks for FILE with the ending of its own, whatever FILE has.
fs::path file_given(const fs::path& given, const AnyMesh& mesh) {
  std::error_code ignored;
  fs::path other = given;
  other.replace_extension(mesh.dimension == 2 ? ".mmg2d" : ".mmg3d");
  return !fs::exists(given, ignored) && fs::exists(other, ignored) ? other : given;
}

bool has(const AnyMesh& mesh, const LocalSize& local) {
  const auto among = [&](const std::vector<std::int32_t>& references) {
    return std::find(references.begin(), references.end(), local.reference) != references.end();
  };
  switch (local.dimension) {
    case 0:
      return among(mesh.vertex_reference);
    case 1:
      return among(mesh.edges.reference);
    case 2:
      return among(mesh.triangles.reference);
    default:
      return among(mesh.tetrahedra.reference);
  }
}

void warn(const std::string& file, const std::vector<LocalSize>& local_sizes, const AnyMesh& mesh,
          double hausdorff_tolerance, Warnings& warnings) {
  std::string missing;
  bool tolerances = false;
  for (const LocalSize& local : local_sizes) {
    if (!has(mesh, local))
      missing += (missing.empty() ? "" : ", ") + std::to_string(local.reference);
    tolerances |= local.hausdorff_tolerance > 0 && local.hausdorff_tolerance != hausdorff_tolerance;
  }
  if (!missing.empty())
    warnings.push_back(file + ": nothing in the mesh has the references " + missing);
  if (tolerances)
    warnings.push_back(file +
                       ": left out hausd, which is the same for all boundaries here (-hausd)");
}

/// Widens the bounds to include all local ones.
void widen(meshadapt::AdaptOptions& adapt, const std::vector<LocalSize>& local_sizes) {
  for (const LocalSize& local : local_sizes) {
    if (local.smallest > 0) adapt.smallest_size = std::min(adapt.smallest_size, local.smallest);
    if (local.largest > 0) adapt.smallest_size = std::min(adapt.smallest_size, local.largest);
    if (adapt.largest_size > 0)
      adapt.largest_size = std::max({adapt.largest_size, local.largest, local.smallest});
  }
}

}  // namespace

std::optional<fs::path> parameter_file(const std::optional<fs::path>& given, const AnyMesh& mesh) {
  return given ? file_given(*given, mesh) : file_beside(mesh);
}

std::vector<LocalSize> local_parameters(const std::optional<fs::path>& given, const AnyMesh& mesh,
                                        const meshadapt::AdaptOptions& adapt, Warnings& warnings) {
  const std::optional<fs::path> file = parameter_file(given, mesh);
  if (!file) return {};
  std::vector<LocalSize> local_sizes = meshadapt::read_local_sizes(*file, &warnings);
  for (const LocalSize& local : local_sizes)
    if (local.dimension > mesh.dimension)
      throw meshadapt::InputError(file->string() + ": expected entities of a mesh of dimension " +
                                  std::to_string(mesh.dimension) + ", found tetrahedra");
  if (!given) warnings.push_back(file->string() + ": local parameters found; they bound sizes");
  warn(file->string(), local_sizes, mesh, adapt.make.hausdorff_tolerance, warnings);
  return local_sizes;
}

void bound_locally(const runtime::Executor& executor, const AnyMesh& mesh,
                   const std::vector<LocalSize>& local_sizes, meshadapt::AnyField& metric,
                   meshadapt::AdaptOptions& adapt) {
  if (local_sizes.empty()) return;
  metric = meshadapt::bound_sizes_locally(executor, mesh, metric, local_sizes,
                                          {adapt.smallest_size, adapt.largest_size});
  widen(adapt, local_sizes);
}

}  // namespace ductile::cli
