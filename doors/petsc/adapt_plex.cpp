#include "adapt_plex.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include "distributed/adapt_parts.hpp"
#include "distributed/communicator.hpp"
#include "metric.hpp"
#include "parameters.hpp"
#include "plex.hpp"
#include "plex_geometry.hpp"
#include "read_plex.hpp"
#include "vectors.hpp"
#include "write_plex.hpp"

namespace ductile::petsc {

namespace {

/// Prints warnings, which the first rank has.
void warn(const meshadapt::Warnings& warnings) {
  for (const std::string& warning : warnings)
    std::fprintf(PETSC_STDERR, "ductile: warning: %s\n", warning.c_str());
}

DM adapted_plex(MPI_Comm handle, DM dm, Vec metric, DMLabel facets, DMLabel cells) {
  const Communicator comm(handle);
  Parameters parameters = parameters_of(dm);
  const int threads = threads_of(comm, dm);
  const runtime::Executor executor =
      comm.on_all([&] { return runtime::Executor({.threads = threads}); });
  const CarriedLabels labels = labels_of(comm, dm, metric != nullptr ? facets : nullptr,
                                         metric != nullptr ? cells : nullptr);
  PlexPart read = read_plex(comm, dm, labels);
  auto& adapt = parameters.options.adapt;
  if (adapt.make.hausdorff_tolerance > 0)
    adapt.make.geometry = geometry_of_plex(comm, executor, dm, labels, adapt.make);
  read.part.wanted = metric != nullptr ? metric_of_vector(comm, dm, metric, read,
                                                          {adapt.smallest_size, adapt.largest_size})
                                       : metric_of_label(comm, executor, facets, read);
  if (parameters.verbosity > 0)
    parameters.options.told = [&](const PassReport& pass) {
      check(PetscPrintf(handle, "ductile: %s\n", to_text(pass).c_str()));
    };
  const AdaptedParts parts = adapt_parts(comm, executor, std::move(read.part), parameters.options);
  warn(parts.warnings);
  DM adapted = write_plex(comm, parts, labels);
  pass_geometry_on(dm, adapted);
  compose_vectors(comm, executor, dm, parts, adapted);
  return adapted;
}

}  // namespace

PetscErrorCode adapt_plex(DM dm, Vec metric, DMLabel facets, DMLabel cells, DM* adapted) {
  PetscFunctionBegin;
  MPI_Comm comm = MPI_COMM_NULL;
  PetscCall(PetscObjectGetComm(reinterpret_cast<PetscObject>(dm), &comm));
  const auto failure =
      failure_of([&] { *adapted = adapted_plex(comm, dm, metric, facets, cells); });
  PetscCheck(!failure, comm, PETSC_ERR_LIB, "Ductile: %s", failure->c_str());
  PetscFunctionReturn(0);
}

}  // namespace ductile::petsc
