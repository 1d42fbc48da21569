#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/check_input.hpp"
#include "geometry/facet_sides.hpp"
#include "geometry/surface_mesh.hpp"
#include "mesh/scale.hpp"
#include "mesh/sorted_cells.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// Leaves triangles out and turns them, see mended_surface().
class SurfaceMender {
 public:
  SurfaceMender(const Executor& executor, const AnyMesh& any, std::vector<std::string>& warnings)
      : executor_(executor), any_(any), warnings_(warnings) {}

  std::optional<AnyMesh> run() {
    choose();
    orient();
    if (warnings_said_ == 0) return std::nullopt;
    AnyMesh mended = any_;
    mended.triangles.vertices = corners_;
    for (std::size_t e = 0; e < chosen_.size(); ++e)
      mended.triangles.reference[e] = any_.triangles.reference[chosen_[e]];
    mended.triangles.reference.resize(chosen_.size());
    mended.required_triangles.clear();
    const auto required = marked(any_, any_.triangles.size(), any_.required_triangles, "triangle");
    for (std::uint32_t e = 0; e < chosen_.size(); ++e)
      if (required[chosen_[e]]) mended.required_triangles.push_back(e);
    return mended;
  }

 private:
  /// Lists the triangles that have an area, each once.
  void choose() {
    const auto& triangles = any_.triangles.vertices;
    const auto keyed = sorted_cells(executor_, triangles);
    std::vector<std::uint8_t> left_out(triangles.size(), 0);
    parallel_for(executor_, triangles.size(), [&](std::size_t t) {
      const auto [a, b, c] = points_in<3>(any_, triangles[t]);
      if (!(certain_area(a, b, c) > 0)) left_out[t] = 1;
    });
    for (std::size_t i = 1; i < keyed.size(); ++i)
      if (keyed[i].first == keyed[i - 1].first && left_out[keyed[i].second] == 0)
        left_out[keyed[i].second] = 2;
    report(left_out, 1, "have no area and are left out");
    report(left_out, 2, "are listed twice and are left out");
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      if (left_out[t] == 0) chosen_.push_back(t);
    if (chosen_.empty()) refuse_mesh(any_, "expected triangles with an area, found none");
  }

  void report(const std::vector<std::uint8_t>& flags, std::uint8_t flag, const std::string& what) {
    const auto first = std::find(flags.begin(), flags.end(), flag);
    if (first == flags.end()) return;
    ++warnings_said_;
    warnings_.push_back(name_of(any_) + ": " +
                        std::to_string(std::count(flags.begin(), flags.end(), flag)) + " of " +
                        std::to_string(flags.size()) + " triangles " + what + "; the first is " +
                        entity("triangle", static_cast<std::size_t>(first - flags.begin())));
  }

  // ---- Orientation: neighbours pass their common edge in opposite directions ----

  void orient() {
    corners_.resize(chosen_.size());
    parallel_for(executor_, chosen_.size(),
                 [&](std::size_t e) { corners_[e] = any_.triangles.vertices[chosen_[e]]; });
    const FacetSides<3> sides(executor_, corners_.size(),
                              [&](std::size_t e) { return corners_[e]; });
    if (seams_of(sides, corners_).empty()) return;
    std::vector<std::uint8_t> turned(corners_.size(), none_yet);
    std::vector<ElementId> part;
    for (ElementId seed = 0; seed < corners_.size(); ++seed)
      if (turned[seed] == none_yet) turn_part(sides, seed, turned, part);
    std::vector<std::uint8_t> listed(any_.triangles.size(), 0);
    for (std::size_t e = 0; e < corners_.size(); ++e) {
      listed[chosen_[e]] = turned[e];
      if (turned[e] != 0) std::swap(corners_[e][1], corners_[e][2]);
    }
    report(listed, 1, "were turned as most of their neighbours are");
  }

  /// Turns what is connected with a triangle by edges of two as that is, or as most of it is.
  void turn_part(const FacetSides<3>& sides, ElementId seed, std::vector<std::uint8_t>& turned,
                 std::vector<ElementId>& part) const {
    part.assign(1, seed);
    turned[seed] = 0;
    std::size_t count = 0;
    for (std::size_t at = 0; at < part.size(); ++at)
      each_side<3>(corners_[part[at]], [&](SideKey key) {
        const auto both = sides.at(key);
        if (both.size() != 2) return;
        const ElementId other = both[both[0].facet == part[at] ? 1 : 0].facet;
        if (turned[other] != none_yet) return;
        turned[other] =
            turned[part[at]] ^ static_cast<std::uint8_t>(are_opposite(corners_, both[0], both[1]));
        count += turned[other];
        part.push_back(other);
      });
    if (2 * count > part.size())
      for (const ElementId e : part) turned[e] ^= 1U;
  }

  static constexpr std::uint8_t none_yet = 2;

  const Executor& executor_;
  const AnyMesh& any_;
  std::vector<std::string>& warnings_;
  std::size_t warnings_said_ = 0;
  std::vector<std::uint32_t> chosen_;  // [triangle], its number in the file
  std::vector<Corners<2>> corners_;    // [triangle]
};

}  // namespace

std::optional<AnyMesh> mended_surface(const Executor& executor, const AnyMesh& any,
                                      const MakeMeshOptions& options,
                                      std::vector<std::string>& warnings) {
  check_input<2, 3>(executor, any, options);
  return SurfaceMender(executor, any, warnings).run();
}

}  // namespace ductile::meshadapt
