#include "adapt/rescue.hpp"

#include <algorithm>
#include <iterator>

#include "ductile/meshadapt/check_mesh.hpp"
#include "geometry/damage.hpp"

namespace ductile::meshadapt {

namespace {

/// After as many attempts nothing that is curved may change, and then no facet.
constexpr int most_local_attempts = 6;

}  // namespace

template <int Dim>
Rescue<Dim>::Rescue(const runtime::Executor& executor, const AnyMesh& input,
                    const MakeMeshOptions& options)
    : executor_(executor),
      input_(input),
      options_(options),
      from_(options.complete_boundary ? BoundaryFrom::elements : BoundaryFrom::listed_facets),
      tolerance_(options.hausdorff_tolerance),
      distance_(options.hausdorff_tolerance) {}

template <int Dim>
bool Rescue<Dim>::accepts(const AnyMesh& adapted) {
  ++attempts_;
  const auto faults = check_adapted(executor_, input_, adapted, tolerance_);
  is_right_ = faults.empty();
  if (is_right_ || options_.lock_boundary) return true;
  if (first_fault_.empty()) first_fault_ = faults.front();
  if (options_.hausdorff_tolerance == 0)
    options_.lock_boundary = true;
  else if (attempts_ >= most_local_attempts || !keeps_more(adapted))
    options_.hausdorff_tolerance = 0;
  return false;
}

/// Each time from farther away, as facets of the adapted mesh may have been larger before.
template <int Dim>
bool Rescue<Dim>::keeps_more(const AnyMesh& adapted) {
  if (!check_mesh(executor_, adapted).empty()) return false;
  const auto places = damaged_places<Dim>(executor_, input_, adapted, from_);
  const auto near = boundary_vertices_near<Dim>(executor_, input_, from_, places, distance_);
  distance_ *= 2;
  std::vector<std::uint32_t> all;
  std::set_union(options_.keep_facets_at.begin(), options_.keep_facets_at.end(), near.begin(),
                 near.end(), std::back_inserter(all));
  const bool more = all.size() > options_.keep_facets_at.size();
  options_.keep_facets_at = std::move(all);
  return more;
}

template <int Dim>
void Rescue<Dim>::warn(std::vector<std::string>& warnings) const {
  if (attempts_ < 2 || !is_right_) return;
  std::string kept = "all facets of the boundary";
  if (options_.hausdorff_tolerance > 0)
    kept = "facets at " + std::to_string(options_.keep_facets_at.size()) +
           " vertices of curved boundaries";
  else if (!options_.lock_boundary)
    kept = "all facets of curved boundaries";
  warnings.push_back(input_.name + ": adapted " + std::to_string(attempts_) + " times, because " +
                     "boundaries that are closer than the surface tolerance met (" + first_fault_ +
                     "); " + kept + " keep their shape");
}

template class Rescue<2>;
template class Rescue<3>;

}  // namespace ductile::meshadapt
