#include "geometry/curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "geometry/curvature_fit.hpp"
#include "geometry/surface.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
double smallest_value(const Metric<Dim>& tensor) {
  const auto values = principal_axes(tensor).value;
  return *std::min_element(values.begin(), values.end());
}

/// The sizes of chords around points of a model's patches, or curves.
template <int Dim, std::size_t Corners>
class ChordSizes {
 public:
  using Model = Sheets<Dim, Corners>;

  ChordSizes(const Model& model, const Samples<Dim, Corners>& samples,
             const std::vector<double>& width_at, double tolerance)
      : model_(model),
        samples_(samples),
        width_at_(width_at),
        tolerance_(tolerance),
        seen_(samples.all.size()) {}

  /// A tensor in which edges as long as the model allows have length 1, if it can say so within
  /// `reach`; one that is too small where they may be longer; 0 if the point is not near the sheet.
  /// Where the sheet bends enough for chords, that may be noise: a fit that bends less counts if it
  /// explains all that is within 1.5 times as far.
  Metric<Dim> at(const Vector<Dim>& point, std::uint32_t sheet, double reach) {
    constexpr double farther_away = 1.5, near = 4;
    const auto nearest = model_.nearest_on(point, sheet, near * model_.tolerance());
    if (!nearest) return {};
    start(nearest->point, samples_.facets[nearest->facet]);
    PrincipalAxes<Dim> curvature = fit_.curvature();
    double limit = reach;
    bool bends_enough = false;
    while (!front_.empty() && found_.size() < most_samples) {
      std::pop_heap(front_.begin(), front_.end(), farther);
      const auto [distance, sample] = front_.back();
      front_.pop_back();
      if (distance > limit) break;
      take(sample, distance);
      if (bends_enough) continue;
      curvature = fit_.curvature();
      bends_enough = found_.size() > fewest_samples && is_enough(largest(curvature), distance);
      if (bends_enough) limit = farther_away * distance;
    }
    const PrincipalAxes<Dim> smoother = fit_.curvature();
    const bool is_rough = largest(smoother) < largest(curvature) && explains_all();
    return sizes(is_rough ? smoother : curvature);
  }

 private:
  /// More samples than this do not improve a fit.
  static constexpr std::size_t most_samples = 100;
  /// So many beside the closest give directions.
  static constexpr std::size_t fewest_samples = Corners == 2 ? 2 : 6;
  /// The distance, in longest allowed chords, up to which samples are used: where edges are that
  /// long, it reaches the next vertices, among which bends to and fro cancel.
  static constexpr double chords = 1.25;
  using Place = std::pair<double, std::uint32_t>;  // distance, sample

  static bool farther(const Place& a, const Place& b) { return a > b; }
  const Vector<Dim>& position(std::uint32_t sample) const { return samples_.all[sample].position; }

  /// Calls visit(sample) for those next to a sample, some more than once, and for itself.
  void each_next(std::uint32_t sample, auto&& visit) const {
    for (const std::uint32_t facet : samples_.facets_at(sample))
      for (const std::uint32_t next : samples_.facets[facet]) visit(next);
  }

  void start(const Vector<Dim>& point, const typename Samples<Dim, Corners>::Facet& facet) {
    front_.clear();
    found_.clear();
    origin_ = point;
    ++round_;
    for (const std::uint32_t sample : facet) see(sample);
    fit_ = CurvatureFit<Dim, Corners>(direction_at(front_.front().second));
  }

  /// That of a sample. Among needles it may say nothing: where the largest part beside the sample
  /// is turned by 45 degrees against it, that part's.
  const Vector<Dim>& direction_at(std::uint32_t sample) const {
    constexpr double least_turn = 0.7;
    std::uint32_t widest = sample;
    each_next(sample, [&](std::uint32_t next) {
      if (samples_.all[next].area > samples_.all[widest].area) widest = next;
    });
    const auto &own = samples_.all[sample].direction, &wide = samples_.all[widest].direction;
    return std::abs(dot(own, wide)) < least_turn ? wide : own;
  }

  void see(std::uint32_t sample) {
    if (std::exchange(seen_[sample], round_) == round_) return;
    front_.emplace_back(norm(position(sample) - origin_), sample);
    std::push_heap(front_.begin(), front_.end(), farther);
  }

  void take(std::uint32_t sample, double distance) {
    found_.emplace_back(distance, sample);
    const auto& found = samples_.all[sample];
    fit_.add(found.position - origin_, found.direction, found.area);
    each_next(sample, [&](std::uint32_t next) { see(next); });
  }

  /// Are all places where the fit says, within half of the tolerance?
  bool explains_all() const {
    Box<Dim> box = Box<Dim>::empty();
    const auto rise = fit_.rise();
    for (const auto& [distance, sample] : found_)
      box = join(box, box_around(std::array{rise(position(sample) - origin_)}));
    return norm(box.high - box.low) <= tolerance_;
  }

  /// Is the distance that of the chords that a curvature allows, see bound_curved_sizes()?
  bool is_enough(double curvature, double distance) const {
    return curvature * distance * distance >= 8 * tolerance_ * chords * chords;
  }

  static double largest(const PrincipalAxes<Dim>& axes) {
    return *std::max_element(axes.value.begin(), axes.value.end());
  }

  /// Chords in the directions in which it bends; across the surface, and in the plane of a curve,
  /// the first axis, as in the direction in which it bends most.
  Metric<Dim> sizes(PrincipalAxes<Dim> axes) const {
    const double most = largest(axes);
    if (!(most > 0)) return {};
    const double near = std::sqrt(8 * tolerance_ / most) / 2;
    axes.value[0] = 0;
    for (std::size_t i = 1; i < Dim; ++i) {
      const double size =
          std::max(std::sqrt(8 * tolerance_ / axes.value[i]), least_size(axes.vector[i], near));
      axes.value[i] = 1 / (size * size);
      axes.value[0] = std::max(axes.value[0], axes.value[i]);
    }
    return compose(axes);
  }

  /// In a direction, that of the flat parts around: to divide these brings nothing closer.
  double least_size(const Vector<Dim>& direction, double near) const {
    double least = 2 * tolerance_;
    for (const auto& found : found_) {
      const std::uint32_t sample = found.second;
      if (found.first > near && found_.size() >= 8) continue;
      least = std::max(least, width_at_[sample]);
      each_next(sample, [&](std::uint32_t next) {
        least = std::max(least, extent(position(next) - position(sample), direction));
      });
    }
    return least;
  }

  /// The length of an edge that goes about in a direction; of another one, how far it goes in it.
  static double extent(const Vector<Dim>& edge, const Vector<Dim>& direction) {
    const double length = norm(edge), along = std::abs(dot(edge, direction));
    return along > length / 2 ? length : along;
  }

  const Model& model_;
  const Samples<Dim, Corners>& samples_;
  const std::vector<double>& width_at_;
  double tolerance_;
  std::vector<std::uint32_t> seen_;  // [sample], in which round last
  std::uint32_t round_ = 0;
  std::vector<Place> front_, found_;
  CurvatureFit<Dim, Corners> fit_;
  Vector<Dim> origin_;
};

/// The metric made as fine as a tensor, which may ask for nothing in some directions.
template <int Dim>
Metric<Dim> bounded(const Metric<Dim>& metric, const Metric<Dim>& tensor) {
  const double least = smallest_value(metric);
  PrincipalAxes<Dim> axes = principal_axes(tensor);
  bool binds = false;
  for (double& value : axes.value) {
    if (!std::isfinite(value)) return metric;
    binds = binds || value > least;
    value = std::max(value, least);
  }
  return binds ? intersect(metric, compose(axes)) : metric;
}

/// A vertex of a mesh on a patch, or a curve, of the model.
struct OnSheet {
  VertexId vertex;
  std::uint32_t sheet;
  auto operator<=>(const OnSheet&) const = default;
};

template <int Dim>
runtime::UnsetVector<OnSheet> on_patches(const runtime::Executor& executor, const Mesh<Dim>& mesh) {
  return runtime::parallel_collect<OnSheet>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        if (!mesh.alive(static_cast<ElementId>(e))) return;
        for (std::size_t i = 0; i <= Dim; ++i) {
          const Patch<Dim>& patch = mesh.patches[mesh.patches_of[e][i]];
          if (!patch.smooth) continue;
          for (const VertexId v : facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i)))
            append({v, patch.sheet});
        }
      });
}

template <int Dim>
runtime::UnsetVector<OnSheet> on_curves(const runtime::Executor& executor, const Mesh<Dim>& mesh) {
  return runtime::parallel_collect<OnSheet>(
      executor, mesh.vertex_slots(), [&](std::size_t v, auto&& append) {
        const auto vertex = static_cast<VertexId>(v);
        if (Dim == 2 || mesh.kind_of[v].class_dimension > 1 || !mesh.vertex_alive(vertex)) return;
        for (const CurveLink& link : mesh.links_of.of(vertex))
          if (mesh.curves[link.curve].smooth) append({vertex, mesh.curves[link.curve].sheet});
      });
}

template <int Dim>
struct SizeBounder {
  const runtime::Executor& executor;
  const Mesh<Dim>& mesh;
  double tolerance;
  std::vector<Metric<Dim>>& metric_of;

  /// Bounds the metrics at places on these sheets of the model.
  template <std::size_t Corners>
  void bound(const Sheets<Dim, Corners>& model, const Samples<Dim, Corners>& samples,
             runtime::UnsetVector<OnSheet> places) const {
    constexpr double flat = 0.02;  // of the tolerance: a tenth of the longest chord on an arc
    if (places.empty()) return;
    runtime::parallel_sort(executor, std::span(places));
    places.erase(std::unique(places.begin(), places.end()), places.end());
    const std::vector<double> width_at = samples.widths(executor, flat * tolerance);
    std::vector<Metric<Dim>> sizes_of(places.size());
    const std::size_t block_size = std::max<std::size_t>(1024, places.size() / 64);
    runtime::parallel_for_blocks(
        executor, places.size(), block_size, [&](std::size_t, std::size_t begin, std::size_t end) {
          ChordSizes<Dim, Corners> sizes(model, samples, width_at, tolerance);
          for (std::size_t i = begin; i < end; ++i) {
            const auto [v, sheet] = places[i];
            const double largest = 1 / std::sqrt(smallest_value(metric_of[v]));
            sizes_of[i] = sizes.at(mesh.site_of[v].position, sheet, largest);
          }
        });
    runtime::parallel_for(executor, places.size(), [&](std::size_t begin) {
      const VertexId v = places[begin].vertex;
      if (begin > 0 && places[begin - 1].vertex == v) return;
      for (std::size_t i = begin; i < places.size() && places[i].vertex == v; ++i)
        metric_of[v] = bounded(metric_of[v], sizes_of[i]);
    });
  }
};

}  // namespace

template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of) {
  const Surface<Dim>& model = *mesh.surface;
  const SizeBounder<Dim> bounder{executor, mesh, tolerance, metric_of};
  bounder.bound(model.facets, model.facet_samples, on_patches(executor, mesh));
  bounder.bound(model.edges, model.edge_samples, on_curves(executor, mesh));
}

template void bound_curved_sizes(const runtime::Executor&, const Mesh<2>&, double,
                                 std::vector<Metric<2>>&);
template void bound_curved_sizes(const runtime::Executor&, const Mesh<3>&, double,
                                 std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
