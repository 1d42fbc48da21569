#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/unit.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/distance.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
class NoiseNormals {
 public:
  using Points = std::array<Vector<Dim>, Dim>;
  using Others = std::array<std::uint32_t, Dim>;

  NoiseNormals(const BoundaryParts<Dim>& parts, std::span<const Others> beside)
      : mesh_(parts.mesh), facets_(parts.facets), beside_(beside), within_(parts.within) {}

  Vector<Dim> own(std::uint32_t facet) const { return unit(facet_normal(points(facet))); }

  /// Is it lower than noise may be twice, and does it turn by much at a side?
  bool may_be_noise(std::uint32_t facet) const {
    const Points p = points(facet);
    if (!(norm(altitude(p)) < 2 * within_.surface)) return false;
    const Vector<Dim> normal = unit(facet_normal(p));
    return std::any_of(beside_[facet].begin(), beside_[facet].end(), [&](std::uint32_t other) {
      return other != none && sign(facet, other) * dot(normal, own(other)) < within_.least_turn;
    });
  }

  /// As of the facets beside that are noise, if this one is a step of their surface. So it is next
  /// to ridges, which the surroundings of a facet must not contain.
  std::optional<Vector<Dim>> as_beside(std::uint32_t facet,
                                       std::span<const Vector<Dim>> normal_of) const {
    Vector<Dim> sum;
    for (const std::uint32_t other : beside_[facet])
      if (other != none) sum += sign(facet, other) * normal_of[other];
    if (!(norm(sum) > 0)) return {};
    constexpr double most_rise = 1.5;  // of the tolerance; what is behind a ridge rises by twice
    const Vector<Dim> normal = unit(sum);
    if (dot(own(facet), normal) > within_.least_turn) return normal;
    if (!(rise(facet, normal) < most_rise * within_.surface)) return {};
    return normal;
  }

  /// The normal of the surface around a facet, if it is smooth.
  std::optional<Vector<Dim>> around(std::uint32_t facet) const {
    const std::vector<Place> places = places_around(facet);
    Vector<Dim> sum;
    double area = 0;
    for (const Place& place : places) {
      sum += place.normal;
      area += norm(place.normal);
    }
    constexpr double least = 0.5;  // three sides of a cube at a corner have more
    if (!(norm(sum) >= least * area)) return {};
    const Vector<Dim> normal = unit(sum);
    if (!(std::abs(dot(altitude(points(facet)), normal)) < within_.surface)) return {};
    for (const Vector<Dim>& across : divisions(normal))
      if (turns(places, across, area)) return {};
    return normal;
  }

 private:
  struct Place {
    Vector<Dim> centre;  // from that of the facet in question
    Vector<Dim> normal;  // as long as the facet is large, and to the same side
  };

  static constexpr double reach = 2;  // of the tolerance

  Points points(std::uint32_t facet) const {
    const Facet<Dim> corners = outward_corners(mesh_, facets_[facet]);
    Points p;
    for (std::size_t i = 0; i < Dim; ++i) p[i] = mesh_.site_of[corners[i]].position;
    return p;
  }

  static Vector<Dim> centre(const Points& p) {
    Vector<Dim> centre;
    for (const Vector<Dim>& corner : p) centre += (1.0 / Dim) * corner;
    return centre;
  }

  /// From the longest side to the corner across, at a right angle; in 2D along the edge.
  static Vector<Dim> altitude(const Points& p) {
    if constexpr (Dim == 2) return p[1] - p[0];
    std::size_t at = 0;
    const auto side = [&](std::size_t i) { return p[(i + 1) % Dim] - p[i]; };
    for (std::size_t i = 1; i < Dim; ++i)
      if (dot(side(i), side(i)) > dot(side(at), side(at))) at = i;
    const Vector<Dim> along = side(at), to = p[(at + 2) % Dim] - p[at];
    return to - (dot(to, along) / dot(along, along)) * along;
  }

  /// The rise of a facet and its smooth continuation in a direction, as far as noise may reach.
  double rise(std::uint32_t facet, const Vector<Dim>& direction) const {
    const Vector<Dim> origin = centre(points(facet)), normal = own(facet);
    const double far = reach * within_.surface;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto goes_on = [&](std::uint32_t f, double side) {
      const Points p = points(f);
      if (!(side * dot(unit(facet_normal(p)), normal) > within_.least_turn)) return false;
      for (const Vector<Dim>& corner : p) {
        const Vector<Dim> away = corner - origin;
        const double height = dot(away, direction) * std::min(1.0, far / norm(away));
        low = std::min(low, height);
        high = std::max(high, height);
      }
      return true;
    };
    visit_around(facet, goes_on);
    return high - low;
  }

  double sign(std::uint32_t f, std::uint32_t g) const {
    return face_alike(mesh_, facets_[f], facets_[g]) ? 1 : -1;
  }

  /// Facets that follow each other from one on, as far as they are close to its centre; past those
  /// for which visit(facet, side) says so. The side is -1 where a facet faces the other way.
  void visit_around(std::uint32_t facet, auto&& visit) const {
    constexpr std::size_t most = 400;
    const Vector<Dim> origin = centre(points(facet));
    std::vector<std::pair<std::uint32_t, double>> found{{facet, 1}};
    const auto is_found = [&](std::uint32_t f) {
      return std::any_of(found.begin(), found.end(),
                         [&](const auto& known) { return known.first == f; });
    };
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto [f, side] = found[i];
      if (!visit(f, side)) continue;
      for (const std::uint32_t next : beside_[f]) {
        if (next == none || found.size() == most || is_found(next)) continue;
        if (norm(closest_point(points(next), origin) - origin) <= reach * within_.surface)
          found.emplace_back(next, side * sign(f, next));
      }
    }
  }

  std::vector<Place> places_around(std::uint32_t facet) const {
    const Vector<Dim> origin = centre(points(facet));
    std::vector<Place> places;
    visit_around(facet, [&](std::uint32_t f, double side) {
      const Points p = points(f);
      places.push_back({centre(p) - origin, side * facet_normal(p)});
      return true;
    });
    return places;
  }

  /// Directions at a right angle to a normal, evenly around it, none opposite to another.
  static std::vector<Vector<Dim>> divisions(const Vector<Dim>& normal) {
    if constexpr (Dim == 2) return {{{-normal[1], normal[0]}}};
    constexpr int count = 8;
    std::vector<Vector<Dim>> directions;
    if constexpr (Dim == 3) {
      const Vector<3> u = unit(cross(normal, axis_across(normal))), v = cross(normal, u);
      for (int i = 0; i < count; ++i) {
        const double angle = i * std::numbers::pi / count;
        directions.push_back(std::cos(angle) * u + std::sin(angle) * v);
      }
    }
    return directions;
  }

  /// Do those ahead of the facet and those behind it, on the mean, turn by much?
  bool turns(const std::vector<Place>& places, const Vector<Dim>& across, double area) const {
    constexpr double little = 0.15;                // of the area, which says nothing
    const double between = 0.5 * within_.surface;  // what is as close counts for both
    Vector<Dim> ahead, behind;
    double ahead_area = 0, behind_area = 0;
    for (const Place& place : places) {
      const double share = std::clamp(0.5 + dot(place.centre, across) / between, 0.0, 1.0);
      const double size = norm(place.normal);
      ahead += share * place.normal;
      behind += (1 - share) * place.normal;
      ahead_area += share * size;
      behind_area += (1 - share) * size;
    }
    return std::min(ahead_area, behind_area) > little * area &&
           dot(ahead, behind) < within_.least_turn * norm(ahead) * norm(behind);
  }

  const Mesh<Dim>& mesh_;
  const std::vector<TaggedFacet<Dim>>& facets_;
  std::span<const Others> beside_;
  const Tolerances& within_;
};

/// From what is noise to what is beside it, towards ridges.
template <int Dim>
void spread(const runtime::Executor& executor, const NoiseNormals<Dim>& normals,
            std::vector<Vector<Dim>>& normal_of) {
  constexpr int most_rounds = 16;
  std::vector<Vector<Dim>> next = normal_of;
  for (int round = 0; round < most_rounds; ++round) {
    runtime::parallel_for(executor, normal_of.size(), [&](std::size_t i) {
      const auto f = static_cast<std::uint32_t>(i);
      if (norm(normal_of[f]) > 0 || !normals.may_be_noise(f)) return;
      if (const auto normal = normals.as_beside(f, normal_of)) next[f] = *normal;
    });
    if (next == normal_of) return;
    normal_of = next;
  }
}

}  // namespace

template <int Dim>
void find_noise(BoundaryParts<Dim>& parts, std::span<const std::array<std::uint32_t, Dim>> beside) {
  const NoiseNormals<Dim> normals(parts, beside);
  std::vector<Vector<Dim>> normal_of(parts.facets.size());
  runtime::parallel_for(parts.executor, normal_of.size(), [&](std::size_t i) {
    const auto f = static_cast<std::uint32_t>(i);
    if (normals.may_be_noise(f)) normal_of[f] = normals.around(f).value_or(Vector<Dim>{});
  });
  const auto is_own = [](const Vector<Dim>& normal) { return !(dot(normal, normal) > 0); };
  if (std::all_of(normal_of.begin(), normal_of.end(), is_own)) return;
  spread(parts.executor, normals, normal_of);
  parts.noise_normals = std::move(normal_of);
}

template void find_noise<2>(BoundaryParts<2>&, std::span<const std::array<std::uint32_t, 2>>);
template void find_noise<3>(BoundaryParts<3>&, std::span<const std::array<std::uint32_t, 3>>);

}  // namespace ductile::meshadapt
