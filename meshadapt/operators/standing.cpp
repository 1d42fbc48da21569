#include "operators/standing.hpp"

#include <algorithm>

#include "core/quality.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
Standing standing_of(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                     const EdgeRange& range, double poor) {
  const EdgeRange twice{range.shortest / 2, 2 * range.longest};
  const auto look = [&](std::size_t i) -> Standing {
    const auto e = static_cast<ElementId>(i);
    if (!mesh.alive(e)) return {};
    const double ratio = std::max(0.0, mean_ratio<Dim>(mesh.quality_of[e]));
    Standing one{.elements = 1, .qualities = 1 - ratio, .poor = ratio < poor ? 1.0 : 0};
    for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k) {
      const auto [a, b] = ends_of_edge<Dim>(mesh.corners_of[e], k);
      const EndSquares edge = end_squares(mesh.site_of[a], mesh.site_of[b]);
      if (range.contains(edge)) continue;
      one.lengths += 1.0 / Simplex<Dim>::edges;
      if (!twice.contains(edge)) one.far = 1;
    }
    return one;
  };
  const auto add = [](const Standing& a, const Standing& b) -> Standing {
    return {a.elements + b.elements, a.qualities + b.qualities, a.lengths + b.lengths,
            a.poor + b.poor, a.far + b.far};
  };
  return runtime::parallel_reduce(executor, mesh.element_slots(), Standing{}, look, add);
}

bool is_better(const Standing& after, const Standing& before, const Clearly& clearly) {
  constexpr double hardly = 1.02, chance = 3;  // the last: elements
  const auto per_element = [](const Standing& standing, double sum) {
    return sum / static_cast<double>(std::max<std::size_t>(1, standing.elements));
  };
  struct Fault {
    double after, before;
    bool is_less(const Clearly& by) const {
      return after < by.part * before && after < before - by.least;
    }
    bool is_at_most(double times) const { return after <= times * before; }
  };
  const Fault qualities{per_element(after, after.qualities), per_element(before, before.qualities)};
  const Fault lengths{per_element(after, after.lengths), per_element(before, before.lengths)};
  return (qualities.is_less(clearly) && lengths.is_at_most(hardly)) ||
         (lengths.is_less(clearly) && qualities.is_at_most(clearly.qualities)) ||
         per_element(after, after.poor + chance) < 0.5 * per_element(before, before.poor) ||
         per_element(after, after.far + chance) < 0.5 * per_element(before, before.far) ||
         (2 * after.elements < before.elements && after.far <= before.far);
}

template Standing standing_of<2>(const runtime::Executor&, const Mesh<2>&, const EdgeRange&,
                                 double);
template Standing standing_of(const runtime::Executor&, const Mesh<2, 3>&, const EdgeRange&,
                              double);
template Standing standing_of<3>(const runtime::Executor&, const Mesh<3>&, const EdgeRange&,
                                 double);

}  // namespace ductile::meshadapt
