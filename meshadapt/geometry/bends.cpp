#include "geometry/bends.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/unit.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "geometry/surface.hpp"

namespace ductile::meshadapt {

namespace {

/// weight * v v' of the unit vector in a direction; 0 if there is none.
template <int Dim>
Metric<Dim> square(double weight, const Vector<Dim>& direction) {
  Metric<Dim> result;
  const double squared = dot(direction, direction);
  if (!(squared > 0)) return result;
  std::size_t at = 0;
  for (int j = 0; j < Dim; ++j)
    for (int i = 0; i <= j; ++i) result.m[at++] = weight * direction[i] * direction[j] / squared;
  return result;
}

/// Builds Bends from the facets of smooth patches, which meet at sides: vertices in 2D, in 3D
/// edges.
template <int Dim>
class BendsMaker {
 public:
  BendsMaker(const runtime::Executor& executor, const Mesh<Dim>& mesh, Bends<Dim>& bends)
      : executor_(executor), mesh_(mesh), nodes_(bends.nodes), next_(bends.next) {}

  void make(double flat) {
    find_facets();
    find_nodes();
    find_sides();
    for (const Facet& facet : facets_) add_facet(facet);
    take_normals();
    for (std::size_t i = 0; i < sides_.size();) i = join(i);
    find_widths(flat);
    connect();
  }

 private:
  static constexpr std::size_t corners = Dim;
  struct Facet {
    PatchId patch;
    std::array<VertexId, corners> vertex;
    std::array<std::uint32_t, corners> node;
    Vector<Dim> normal;  // as long as the facet is large
    double area;
    std::array<std::uint32_t, corners> across;  // [side opposite to a corner], the next facet
  };
  struct Side {
    std::uint32_t low, high;  // nodes; one and the same in 2D
    std::uint32_t facet, opposite;
    auto operator<=>(const Side&) const = default;
  };

  Vector<Dim> at(VertexId v) const { return mesh_.site_of[v].position; }

  /// Each once, though an interface is seen from both sides.
  void find_facets() {
    const auto find = [&](std::size_t e, auto&& append) {
      const auto element = static_cast<ElementId>(e);
      if (!mesh_.alive(element)) return;
      for (int i = 0; i <= Dim; ++i) {
        const PatchId patch = mesh_.patches_of[e][static_cast<std::size_t>(i)];
        if (!mesh_.patches[patch].smooth) continue;
        const ElementId other = neighbour(mesh_, element, i);
        if (other == none || element < other) append(make_facet(element, i, patch));
      }
    };
    facets_ = runtime::parallel_collect<Facet>(executor_, mesh_.element_slots(), find);
  }

  Facet make_facet(ElementId element, int number, PatchId patch) const {
    Facet facet{};
    facet.patch = patch;
    facet.across.fill(none);
    const auto vertices = facet_of<Dim>(mesh_.corners_of[element], number);
    std::array<Vector<Dim>, corners> p;
    for (std::size_t i = 0; i < corners; ++i) p[i] = at(facet.vertex[i] = vertices[i]);
    facet.normal = facet_normal(p);
    facet.area = norm(facet.normal) / (Dim == 2 ? 1 : 2);
    return facet;
  }

  void find_nodes() {
    auto keys = runtime::make_unset_vector<std::uint64_t>(executor_, corners * facets_.size());
    const auto key = [](const Facet& f, std::size_t i) {
      return std::uint64_t{f.patch} << 32U | f.vertex[i];
    };
    runtime::parallel_for(executor_, facets_.size(), [&](std::size_t f) {
      for (std::size_t i = 0; i < corners; ++i) keys[corners * f + i] = key(facets_[f], i);
    });
    runtime::parallel_sort(executor_, std::span(keys));
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    nodes_.resize(keys.size());
    for (std::size_t n = 0; n < keys.size(); ++n) {
      nodes_[n].vertex = static_cast<VertexId>(keys[n]);
      nodes_[n].patch = static_cast<PatchId>(keys[n] >> 32U);
    }
    runtime::parallel_for(executor_, facets_.size(), [&](std::size_t f) {
      for (std::size_t i = 0; i < corners; ++i) {
        const auto found = std::lower_bound(keys.begin(), keys.end(), key(facets_[f], i));
        facets_[f].node[i] = static_cast<std::uint32_t>(found - keys.begin());
      }
    });
  }

  void find_sides() {
    sides_ = runtime::make_unset_vector<Side>(executor_, corners * facets_.size());
    runtime::parallel_for(executor_, facets_.size(), [&](std::size_t f) {
      const auto& node = facets_[f].node;
      for (std::size_t i = 0; i < corners; ++i) {
        const std::uint32_t a = node[(i + 1) % corners], b = node[(i + corners - 1) % corners];
        sides_[corners * f + i] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(f),
                                   static_cast<std::uint32_t>(i)};
      }
    });
    runtime::parallel_sort(executor_, std::span(sides_));
  }

  /// The facets at the side that begins here go on in each other, if it does not keep them apart.
  /// Returns where the next one begins.
  std::size_t join(std::size_t begin) {
    std::size_t end = begin + 1;
    const auto is_same = [&](const Side& s) {
      return s.low == sides_[begin].low && s.high == sides_[begin].high;
    };
    while (end < sides_.size() && is_same(sides_[end])) ++end;
    const Side& f = sides_[begin];
    if (end - begin != 2 || is_fixed(f)) return end;
    const Side& g = sides_[begin + 1];
    facets_[f.facet].across[f.opposite] = g.facet;
    facets_[g.facet].across[g.opposite] = f.facet;
    return end;
  }

  /// Is the side a corner in 2D, or an edge of a curve?
  bool is_fixed(const Side& side) const {
    const VertexId a = nodes_[side.low].vertex, b = nodes_[side.high].vertex;
    if constexpr (Dim == 2) return mesh_.kind_of[a].class_dimension == 0;
    return mesh_.curve_of(a, b) != 0;
  }

  void add_facet(const Facet& facet) {
    for (const std::uint32_t n : facet.node) {
      nodes_[n].area += facet.area / corners;
      const double side = dot(facet.normal, nodes_[n].normal) < 0 ? -1 : 1;
      nodes_[n].normal += side * facet.normal;
    }
  }

  void take_normals() {
    constexpr double reach = 4;    // of the tolerance
    constexpr double near = 0.95;  // cosine: what is not is the model of needles
    runtime::parallel_for(executor_, nodes_.size(), [&](std::size_t n) {
      BendNode<Dim>& node = nodes_[n];
      node.normal = unit(node.normal);
      const auto& model = mesh_.surface->facets;
      const auto nearest = model.nearest_on(at(node.vertex), mesh_.patches[node.patch].sheet,
                                            reach * model.tolerance());
      if (nearest && std::abs(dot(nearest->direction, node.normal)) > near)
        node.normal = nearest->direction;
    });
  }

  // ---- Flat parts: each grows from its largest facet ----

  void find_widths(double flat) {
    using Seed = std::pair<double, std::uint32_t>;
    auto order = runtime::make_unset_vector<Seed>(executor_, facets_.size());
    runtime::parallel_for(executor_, order.size(), [&](std::size_t f) {
      order[f] = {-facets_[f].area, static_cast<std::uint32_t>(f)};
    });
    runtime::parallel_sort(executor_, std::span(order));
    std::vector<bool> seen(facets_.size());
    std::vector<std::uint32_t> part;
    for (const auto& [size, seed] : order) {
      if (seen[seed]) continue;
      grow(seed, flat, seen, part);
      const double width = width_of(part);
      for (const std::uint32_t f : part)
        for (const std::uint32_t n : facets_[f].node)
          nodes_[n].width = std::max(nodes_[n].width, width);
    }
  }

  void grow(std::uint32_t seed, double flat, std::vector<bool>& seen,
            std::vector<std::uint32_t>& part) const {
    const Vector<Dim> origin = at(facets_[seed].vertex[0]), normal = unit(facets_[seed].normal);
    const auto in_plane = [&](const Facet& facet) {
      return std::all_of(facet.vertex.begin(), facet.vertex.end(),
                         [&](VertexId v) { return std::abs(dot(at(v) - origin, normal)) <= flat; });
    };
    part.assign(1, seed);
    seen[seed] = true;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const std::uint32_t f : facets_[part[i]].across)
        if (f != none && !seen[f] && in_plane(facets_[f])) {
          seen[f] = true;
          part.push_back(f);
        }
  }

  /// Across its narrow direction in 3D: that of a long strip, and nearly the height of a triangle.
  double width_of(std::span<const std::uint32_t> part) const {
    const Vector<Dim> origin = at(facets_[part.front()].vertex[0]);
    Metric<Dim> moments;
    Vector<Dim> first;
    double area = 0;
    for (const std::uint32_t f : part) {
      Vector<Dim> sum;
      const double share = facets_[f].area / (Dim * (Dim + 1));
      for (const VertexId v : facets_[f].vertex) {
        const Vector<Dim> d = at(v) - origin;
        sum += d;
        moments += square(share * dot(d, d), d);
      }
      moments += square(share * dot(sum, sum), sum);
      first += (facets_[f].area / Dim) * sum;
      area += facets_[f].area;
    }
    if (!(area > 0)) return 0;
    moments += square(-dot(first, first) / area, first);
    auto spread = principal_axes(moments).value;
    std::sort(spread.begin(), spread.end());
    return std::sqrt(std::max(0.0, spread[1] / area) * (Dim == 2 ? 12 : 18));
  }

  void connect() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
    for (const Facet& facet : facets_)
      for (std::size_t i = 0; i < corners; ++i)
        for (std::size_t j = 0; j < i; ++j) links.emplace_back(facet.node[j], facet.node[i]);
    next_ = runtime::csr_rows(static_cast<std::uint32_t>(nodes_.size()), links);
  }

  const runtime::Executor& executor_;
  const Mesh<Dim>& mesh_;
  std::vector<BendNode<Dim>>& nodes_;
  runtime::CsrRows& next_;
  runtime::UnsetVector<Facet> facets_;
  runtime::UnsetVector<Side> sides_;  // sorted
};

}  // namespace

template <int Dim>
Bends<Dim>::Bends(const runtime::Executor& executor, const Mesh<Dim>& mesh, double flat) {
  BendsMaker<Dim>(executor, mesh, *this).make(flat);
}

template struct Bends<2>;
template struct Bends<3>;

}  // namespace ductile::meshadapt
