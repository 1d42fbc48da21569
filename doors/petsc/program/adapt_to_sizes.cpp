#include "adapt_to_sizes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "distributed/migrate.hpp"
#include "distributed/parts_geometry.hpp"
#include "first_rank.hpp"

namespace ductile::petsc {

using runtime::Executor;

namespace {

/// The adapted mesh on the first rank, with its next metric; none, on all ranks, if it is final.
std::optional<Part> next(const Communicator& comm, const Executor& executor, Input& input,
                         const Part& part, int pass) {
  Part all = gather_on_first(comm, executor, part);
  bool is_final = false;
  on_first_rank(comm, [&] {
    meshadapt::MeshWithMetric now{mesh_for_file(all, input.file.kept), all.wanted};
    const AnyField* metric = input.places->next(
        {executor, pass, now.mesh, [&]() -> const meshadapt::MeshWithMetric& { return now; }});
    is_final = metric == nullptr;
    if (!is_final) all.wanted = *metric;
  });
  from_first_rank(comm, is_final);
  if (is_final) return std::nullopt;
  return all;
}

}  // namespace

AdaptedParts adapt_to_sizes(const Communicator& comm, const Executor& executor, Input& input,
                            AdaptPartsOptions options) {
  const bool by_places = input.job.places.any();
  if (by_places && comm.size() == 1) options.source = &*input.places;
  AdaptedParts parts = adapt_parts(comm, executor, input.file.part, options);
  for (int pass = 1; by_places && comm.size() > 1; ++pass) {
    const auto again = next(comm, executor, input, parts.part, pass);
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
