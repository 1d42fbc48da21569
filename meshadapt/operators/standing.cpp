#include "operators/standing.hpp"

#include <algorithm>

#include "ductile/meshadapt/quality.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

template <int Dim>
Standing standing_of(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                     const EdgeRange& range, double poor) {
  const auto look = [&](std::size_t i) -> Standing {
    const auto e = static_cast<ElementId>(i);
    if (!mesh.alive(e)) return {};
    const double ratio = std::max(0.0, mean_ratio<Dim>(mesh.shape_of[e]));
    Standing one{.elements = 1, .shapes = 1 - ratio, .lengths = 0, .poor = ratio < poor ? 1.0 : 0};
    for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k) {
      const auto [a, b] = ends_of_edge<Dim>(mesh.corners_of[e], k);
      if (!range.contains(end_squares(mesh.site_of[a], mesh.site_of[b])))
        one.lengths += 1.0 / Simplex<Dim>::edges;
    }
    return one;
  };
  const auto add = [](const Standing& a, const Standing& b) -> Standing {
    return {a.elements + b.elements, a.shapes + b.shapes, a.lengths + b.lengths, a.poor + b.poor};
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
    bool is_no_more() const { return after <= hardly * before; }
  };
  const Fault shapes{per_element(after, after.shapes), per_element(before, before.shapes)};
  const Fault lengths{per_element(after, after.lengths), per_element(before, before.lengths)};
  return (shapes.is_less(clearly) && lengths.is_no_more()) ||
         (lengths.is_less(clearly) && shapes.is_no_more()) ||
         per_element(after, after.poor + chance) < 0.5 * per_element(before, before.poor);
}

template Standing standing_of<2>(const runtime::Executor&, const Mesh<2>&, const EdgeRange&,
                                 double);
template Standing standing_of<3>(const runtime::Executor&, const Mesh<3>&, const EdgeRange&,
                                 double);

}  // namespace ductile::meshadapt
