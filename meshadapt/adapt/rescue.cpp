#include "adapt/rescue.hpp"

#include <algorithm>
#include <iterator>

#include "checks/faults.hpp"
#include "geometry/damage.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

namespace {

/// After as many attempts nothing that is curved may change, and then no facet.
constexpr int most_local_attempts = 6;

}  // namespace

template <int Dim>
Rescue<Dim>::Rescue(const runtime::Executor& executor, const AnyMesh& input,
                    const MakeMeshOptions& options)
    : input_(executor, input),
      options_(options),
      tolerance_(options.hausdorff_tolerance),
      distance_(options.hausdorff_tolerance) {}

template <int Dim>
bool Rescue<Dim>::accepts(AdaptedMesh& adapted, bool may_meet) {
  ++attempts_;
  if (!may_meet && attempts_ == 1) return true;
  const AdjacentMesh now(input_.executor(), adapted.mesh);
  const auto faults = adapted_faults(input_, now, tolerance_);
  // A locked boundary cannot meet itself, but that of a surface is its rims.
  const bool is_rigid =
      options_.lock_boundary && (options_.hausdorff_tolerance == 0 || !is_surface(input_.mesh()));
  if (faults.empty() || is_rigid) {
    complete(adapted.report, faults.empty());
    return true;
  }
  if (first_fault_.empty()) first_fault_ = faults.front();
  if (options_.hausdorff_tolerance == 0)
    options_.lock_boundary = true;
  else if (attempts_ >= most_local_attempts || !keeps_more(now))
    options_.hausdorff_tolerance = 0;
  return false;
}

/// Doubles the distance each time, because facets of the adapted mesh may have been larger before.
template <int Dim>
bool Rescue<Dim>::keeps_more(const AdjacentMesh& adapted) {
  if (!mesh_faults(adapted).empty()) return false;
  const auto places = damaged_places<Dim>(input_, adapted);
  const auto near = boundary_vertices_near(input_, places, distance_);
  distance_ *= 2;
  std::vector<std::uint32_t> all;
  std::set_union(options_.keep_facets_at.begin(), options_.keep_facets_at.end(), near.begin(),
                 near.end(), std::back_inserter(all));
  const bool more = all.size() > options_.keep_facets_at.size();
  options_.keep_facets_at = std::move(all);
  return more;
}

template <int Dim>
void Rescue<Dim>::complete(AdaptReport& report, bool is_right) const {
  report.attempts = attempts_;
  report.checked = is_right;
  if (attempts_ < 2 || !is_right) return;
  std::string kept = "all facets of the boundary";
  if (options_.hausdorff_tolerance > 0)
    kept = "facets at " + std::to_string(options_.keep_facets_at.size()) +
           " vertices of curved boundaries";
  else if (!options_.lock_boundary)
    kept = "all facets of curved boundaries";
  report.warnings.push_back(name_of(input_.mesh()) + ": adapted " + std::to_string(attempts_) +
                            " times, because " +
                            "boundaries that are closer than the surface tolerance met (" +
                            first_fault_ + "); " + kept + " keep their shape");
}

template class Rescue<2>;
template class Rescue<3>;

}  // namespace ductile::meshadapt
