#include "geometry/reference_surface.hpp"

#include <algorithm>
#include <string>

#include "core/first_bad.hpp"
#include "core/unit.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/facet_sides.hpp"

namespace ductile::meshadapt {

namespace {

/// The distance within which a facet's sheet is looked for, in tolerances.
constexpr double near = 50;

template <int Dim>
Vector<Dim> centre_of(const Mesh<Dim>& mesh, const Facet<Dim>& facet) {
  Vector<Dim> centre;
  for (const VertexId v : facet) centre += (1.0 / Dim) * mesh.site_of[v].position;
  return centre;
}

/// Finds the sheets of facets, see ReferenceSurface::sheets_of().
template <int Dim>
class SheetFinder {
 public:
  SheetFinder(const ReferenceSurface<Dim>& reference, const Mesh<Dim>& mesh,
              const std::vector<TaggedFacet<Dim>>& facets)
      : reference_(reference),
        sheets_(reference.surface->facets),
        mesh_(mesh),
        facets_(facets),
        sheet_of_(facets.size(), none),
        distance_of_(facets.size()) {}

  std::vector<std::uint32_t> find(const runtime::Executor& executor) {
    runtime::parallel_for(executor, facets_.size(), [&](std::size_t f) {
      if (facets_[f].data.required) return;
      const auto nearest = nearest_to(f);
      if (!nearest) return;
      sheet_of_[f] = nearest->sheet;
      distance_of_[f] = is_curved(nearest->sheet) ? nearest->distance : 0;
    });
    if (!reference_.in_parts) expect_same_curves();
    take_input_facets();
    return std::move(sheet_of_);
  }

 private:
  using Nearest = typename Surface<Dim>::Facets::Nearest;

  bool is_curved(std::uint32_t sheet) const {
    return sheet != none && reference_.is_smooth[sheet] != 0;
  }
  double fits() const { return fitting * sheets_.tolerance(); }
  Vector<Dim> centre(std::size_t f) const {
    return centre_of<Dim>(mesh_, outward_corners(mesh_, facets_[f]));
  }
  Vector<Dim> direction(std::size_t f) const {
    return unit(normal_of<Dim>(mesh_, outward_corners(mesh_, facets_[f])));
  }

  std::optional<Nearest> nearest_to(std::size_t f) const {
    const std::int32_t reference = facets_[f].data.reference;
    auto nearest = sheets_.nearest(centre(f), direction(f), reference_.reference_of, reference,
                                   near * sheets_.tolerance());
    if (!nearest || (is_curved(nearest->sheet) && nearest->distance > fits())) {
      const auto noise = sheets_.nearest(centre(f), fits());
      if (noise && reference_.reference_of[noise->sheet] == reference) nearest = noise;
    }
    return nearest;
  }

  /// Throws if no facet stands for a curved sheet, unless the mesh has lost all curved boundaries,
  /// for example to a cut: then other facets have their sheets, none has the reference of a curved
  /// one without standing for it, and few lie on curved ones.
  void expect_same_curves() const {
    const auto& smooth = reference_.is_smooth;
    const auto& reference_of = reference_.reference_of;
    const auto curved = [&](std::uint32_t sheet) { return is_curved(sheet); };
    if (std::none_of(smooth.begin(), smooth.end(), [](auto is) { return is != 0; }) ||
        std::any_of(sheet_of_.begin(), sheet_of_.end(), curved))
      return;
    std::size_t known = 0, free = 0, untied = 0, lost = 0, astray = 0;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (facets_[f].data.required) continue;
      ++free;
      const std::int32_t reference = facets_[f].data.reference;
      const auto there = sheets_.nearest(centre(f), fits());
      known += there && !is_curved(there->sheet) && reference_of[there->sheet] == reference;
      if (sheet_of_[f] != none) continue;
      ++untied;
      lost += there && is_curved(there->sheet);
      for (std::size_t sheet = 0; sheet < smooth.size() && astray == 0; ++sheet)
        astray += smooth[sheet] != 0 && reference_of[sheet] == reference;
    }
    if (free == 0 || (known > 0 && astray == 0 && 2 * lost <= untied)) return;
    throw InputError("geometry: none of the facets of the mesh is within " +
                     number(near * sheets_.tolerance()) +
                     " of one of its curved boundaries with the same reference; expected the "
                     "geometry of the same domain");
  }

  /// The model may bulge far from the facets that it was made from. Facets of the mesh that still
  /// lie on these belong to them; others that are far from the model are refused.
  void take_input_facets() {
    std::vector<std::size_t> far;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if (distance_of_[f] > fits()) far.push_back(f);
    std::stable_sort(far.begin(), far.end(), [&](std::size_t a, std::size_t b) {
      return distance_of_[a] > distance_of_[b];
    });
    for (const std::size_t f : far) {
      const auto input = sheets_.nearest_facet(centre(f), direction(f), reference_.reference_of,
                                               facets_[f].data.reference, 2 * distance_of_[f]);
      if (!input || input->distance > fits()) refuse_facet(f);
      sheet_of_[f] = input->sheet;
    }
  }

  [[noreturn]] void refuse_facet(std::size_t f) const {
    std::string vertices;
    for (const VertexId v : facets_[f].corners) vertices += " " + std::to_string(v + 1);
    throw InputError("the boundary's facet with the vertices" + vertices + " is " +
                     number(distance_of_[f]) + " from the geometry, of which the tolerance is " +
                     number(sheets_.tolerance()) +
                     "; is the geometry that of another domain, or was the mesh adapted without "
                     "it or with a larger tolerance?");
  }

  const ReferenceSurface<Dim>& reference_;
  const typename Surface<Dim>::Facets& sheets_;
  const Mesh<Dim>& mesh_;
  const std::vector<TaggedFacet<Dim>>& facets_;
  std::vector<std::uint32_t> sheet_of_;  // [facet]
  std::vector<double> distance_of_;      // [facet], from its sheet; 0 if that is flat
};

}  // namespace

template <int Dim>
std::vector<std::uint32_t> ReferenceSurface<Dim>::sheets_of(
    const runtime::Executor& executor, const Mesh<Dim>& mesh,
    const std::vector<TaggedFacet<Dim>>& facets) const {
  if (!surface) return std::vector<std::uint32_t>(facets.size(), none);
  return SheetFinder<Dim>(*this, mesh, facets).find(executor);
}

template <int Dim>
std::uint32_t ReferenceSurface<Dim>::sheet_of_edge(const std::array<Vector<Dim>, 2>& ends,
                                                   std::int32_t reference) const {
  if (!surface) return none;
  const Vector<Dim> along = ends[1] - ends[0];
  const auto nearest =
      surface->edges.nearest(0.5 * (ends[0] + ends[1]), unit(along), reference_of_curve, reference,
                             fitting * surface->edges.tolerance());
  return nearest ? nearest->sheet : none;
}

template struct ReferenceSurface<2>;
template struct ReferenceSurface<3>;

}  // namespace ductile::meshadapt
