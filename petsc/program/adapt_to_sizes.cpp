#include "adapt_to_sizes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "adapt/sizes_again.hpp"
#include "distributed/migrate.hpp"
#include "distributed/parts_geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "first_rank.hpp"

namespace ductile::petsc {

using runtime::Executor;

namespace {

/// The adapted mesh on the first rank, with the sizes of its places; none, on all ranks, if it
/// already was adapted to about these.
std::optional<Part> lacking(const Communicator& comm, const Executor& executor, const Input& input,
                            const Part& part) {
  Part all = gather_on_first(comm, executor, part);
  bool has_all = false;
  on_first_rank(comm, [&] {
    const AnyMesh mesh = mesh_for_file(all, input.file.kept);
    const meshadapt::SizeBounds bounds{input.job.adapt.smallest_size, input.job.adapt.largest_size};
    const AnyField asked = meshadapt::size_field(executor, mesh, *input.sizes);
    has_all = meshadapt::has_sizes(executor, all.wanted, asked.values, bounds.smallest);
    if (!has_all) all.wanted = meshadapt::metric_of(asked, mesh, bounds);
  });
  from_first_rank(comm, has_all);
  if (has_all) return std::nullopt;
  return all;
}

}  // namespace

AdaptedParts adapt_to_sizes(const Communicator& comm, const Executor& executor, const Input& input,
                            AdaptPartsOptions options) {
  AdaptedParts parts = adapt_parts(comm, executor, input.file.part, options);
  for (int times = 1; input.job.places.any() && times < meshadapt::most_times; ++times) {
    const auto again = lacking(comm, executor, input, parts.part);
    if (!again) break;
    auto& make = options.adapt.make;  // distances are measured from the first mesh
    if (make.hausdorff_tolerance > 0 && !make.geometry)
      make.geometry = geometry_of_parts(comm, executor, input.file.part, make);
    auto warnings = std::move(parts.warnings);
    parts = adapt_parts(comm, executor, *again, options);
    for (const std::string& warning : parts.warnings)
      if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
        warnings.push_back(warning);
    parts.warnings = std::move(warnings);
  }
  return parts;
}

}  // namespace ductile::petsc
