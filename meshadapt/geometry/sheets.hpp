/// @file
/// Sheets: a model of the curved patches, or curves, of a mesh before it was adapted. Tells of a
/// facet, or an edge, that stands for a part of one whether it is close enough to it all over. What
/// is curved is divided into flat parts for that.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/unit.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/divided.hpp"
#include "geometry/projection.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {

/// Unit normal of a facet, or along an edge in 3D; 0 if it is too small to have one.
template <int Dim, std::size_t Corners>
Vector<Dim> direction_of(const std::array<Vector<Dim>, Corners>& corner) {
  Vector<Dim> direction;
  if constexpr (Corners == Dim)
    direction = facet_normal(corner);
  else
    direction = corner[1] - corner[0];
  return unit(direction);
}

/// `Corners` is 2 for edges, 3 for triangles.
template <int Dim, std::size_t Corners>
class Sheets {
 public:
  using Points = std::array<Vector<Dim>, Corners>;
  using Curved = CurvedSimplex<Dim, Corners>;
  /// A part of a sheet.
  struct Part {
    Points corner;
    std::uint32_t sheet;  ///< the number of its patch or curve
    /// It is inside the domain, or an edge, and which way it is turned means nothing. Other facets
    /// are turned outwards.
    bool two_sided;
    Vector<Dim> turned = {};  ///< unit normal that it counts as having, if not 0
  };

  /// What facets, or edges, are made into.
  struct Shapes {
    const std::vector<Part>& facets;
    double tolerance;
    /// [facet], nothing where it stays flat; or empty if all do.
    const std::vector<std::optional<Curved>>& curved;
    /// [sheet], empty where curved pieces are all that is known of it; or empty.
    std::vector<Projection<Dim>> projection_of = {};
    /// The cosine of the angle from which on facets that meet make a ridge.
    double ridge_turn = 0.70710678118654752;
  };
  /// Throws std::bad_alloc. Linear in the facets, times a logarithm. Thread safety: one caller;
  /// runs on the executor.
  Sheets(const runtime::Executor& executor, Shapes shapes);
  /// The same on one thread, of facets that stay flat unless they are curved.
  Sheets(const std::vector<Part>& facets, double tolerance,
         const std::vector<std::optional<Curved>>& curved = {})
      : Sheets(runtime::Executor({.threads = 1}), {facets, tolerance, curved}) {}
  ~Sheets();
  Sheets(const Sheets&) = delete;
  Sheets& operator=(const Sheets&) = delete;

  double tolerance() const { return tolerance_; }

  /// Is the sheet known by a function?
  bool is_exact(std::uint32_t sheet) const {
    return !projection_of_.empty() && projection_of_[sheet];
  }

  /// Is every point of this simplex within the tolerance of the sheet, and half the radius of the
  /// simplex, where it is turned by less than 45 degrees against it? And is none that close to what
  /// faces the sheet, across a gap or a thin part of the domain, unless it is twice as close to the
  /// sheet? Says yes only if it is certain; where the sheet is the graph of a function over the
  /// simplex, and nothing faces it closely, it always is. In 2D, is it also turned by less than
  /// nearly half of the angle of a ridge against the sheet at its ends, so that two such make none?
  /// Thread safety: any thread.
  bool cover(const Points& simplex, std::uint32_t sheet) const;

  /// The point of the sheet closest to a point, nearly, if there is one within this distance and
  /// the tolerance. Where the sheet is curved it is on the curve, not on its flat parts; that of
  /// such a point is the point itself up to rounding. Thread safety: any thread.
  std::optional<Vector<Dim>> closest(const Vector<Dim>& point, std::uint32_t sheet,
                                     double reach) const;

  /// A point of a sheet, and how far it is from that of which it is the closest.
  struct Nearest {
    std::uint32_t sheet;
    std::uint32_t facet;  ///< index into the facets or edges that the sheets were made from
    double distance;
    Vector<Dim> point;
    Vector<Dim> direction;  ///< there: unit normal of a facet, outwards, or along the edge
  };
  /// The closest point of all sheets, nearly, within a distance. Thread safety: any thread.
  std::optional<Nearest> nearest(const Vector<Dim>& point, double reach) const;
  /// The same of one sheet.
  std::optional<Nearest> nearest_on(const Vector<Dim>& point, std::uint32_t sheet,
                                    double reach) const;
  /// The same of the sheets with is_wanted[sheet], at any distance.
  std::optional<Nearest> nearest(const Vector<Dim>& point,
                                 std::span<const std::uint8_t> is_wanted) const;
  /// The same of sheets of one reference, where they are turned by less than 60 degrees against a
  /// direction of unit length. `reference_of` is [sheet].
  std::optional<Nearest> nearest(const Vector<Dim>& point, const Vector<Dim>& direction,
                                 std::span<const std::int32_t> reference_of, std::int32_t reference,
                                 double reach) const;
  /// The same of the flat facets that the sheets were made from, if they have a part in reach.
  std::optional<Nearest> nearest_facet(const Vector<Dim>& point, const Vector<Dim>& direction,
                                       std::span<const std::int32_t> reference_of,
                                       std::int32_t reference, double reach) const;

 private:
  struct Tree;
  struct Near;
  struct Around;
  struct Search;
  struct Shape {
    Vector<Dim> centre;
    Vector<Dim> direction;  // unit normal of a facet, or what it counts as; else along the edge
    double radius;          // of a sphere around the centre
    std::uint32_t sheet;    // as in the part
    bool two_sided;
  };
  struct Closest {
    double distance = std::numeric_limits<double>::infinity();
    Vector<Dim> point;
    std::uint32_t part = 0;
  };

  /// The facet that a flat part comes from, and its place in it, if that is curved.
  struct Origin {
    std::uint32_t facet;
    bool is_curved;
    decltype(DividedPart<Dim, Corners>::weight) weight;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  bool cover(const Points& simplex, std::uint32_t sheet, const Search& search) const;
  bool cover_closely(const Points& simplex, std::uint32_t sheet, const Search& search) const;
  std::optional<Vector<Dim>> direction_around(const Points& simplex, std::uint32_t sheet) const;
  bool counts_as_turned(std::uint32_t part) const {
    return dot(parts_[part].turned, parts_[part].turned) > 0;
  }
  void divide(const runtime::Executor& executor, const Shapes& shapes);
  Points facet_of(std::uint32_t part) const;
  std::optional<typename Curved::Weights> weights_at(const Vector<Dim>& point,
                                                     const Closest& closest) const;
  Vector<Dim> direction_at(const Vector<Dim>& point, const Closest& closest) const;
  Vector<Dim> on_sheet(const Vector<Dim>& point, const Vector<Dim>& model,
                       std::uint32_t sheet) const;
  Nearest nearest_at(const Vector<Dim>& point, const Closest& closest) const;
  std::optional<Nearest> nearest_of(const Vector<Dim>& point, double likely, double reach,
                                    auto&& is_wanted) const;

  void each_meeting(const Box<Dim>& box, auto&& visit) const;

  std::vector<Part> parts_;        // those of a facet follow each other
  std::vector<Origin> origin_of_;  // [part]
  std::vector<Curved> curved_;     // [facet]; empty if all are flat
  std::vector<Shape> shape_of_;    // [part]
  double tolerance_;
  double turn_at_ends_;                         // the least cosine there, in 2D
  std::vector<Projection<Dim>> projection_of_;  // [sheet], or empty
  std::unique_ptr<const Tree> tree_;
};

extern template class Sheets<2, 2>;
extern template class Sheets<3, 2>;
extern template class Sheets<3, 3>;

}  // namespace ductile::meshadapt
