#include "geometry/marked_points.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace ductile::meshadapt {
namespace {

constexpr std::size_t few = 8;

/// Adds the references that all corners of a cell have.
template <int Corners>
void add_whole(const std::vector<std::int32_t>& reference_of, const Cells<Corners>& cells,
               std::set<std::int32_t>& wide) {
  for (const auto& corners : cells.vertices) {
    const std::int32_t first = reference_of[corners[0]];
    if (first != 0 && std::all_of(corners.begin(), corners.end(),
                                  [&](std::uint32_t v) { return reference_of[v] == first; }))
      wide.insert(first);
  }
}

/// Adds the references of three vertices along listed edges.
void add_lines(const std::vector<std::int32_t>& reference_of, const Cells<2>& edges,
               std::set<std::int32_t>& wide) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> steps;  // from a vertex to another
  for (const auto& [a, b] : edges.vertices)
    if (reference_of[a] != 0 && reference_of[a] == reference_of[b] && a != b) {
      steps.emplace_back(a, b);
      steps.emplace_back(b, a);
    }
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());  // some are listed twice
  for (std::size_t i = 1; i < steps.size(); ++i)
    if (steps[i].first == steps[i - 1].first) wide.insert(reference_of[steps[i].first]);
}

}  // namespace

std::vector<std::uint8_t> marked_points(const AnyMesh& mesh) {
  const auto& reference_of = mesh.vertex_reference;
  std::vector<std::uint8_t> marked(reference_of.size(), 0);
  const auto plain = static_cast<std::size_t>(
      std::count(reference_of.begin(), reference_of.end(), std::int32_t{0}));
  const std::size_t labelled = reference_of.size() - plain;
  if (labelled == 0 || (labelled > few && labelled >= plain)) return marked;
  std::set<std::int32_t> wide;
  if (labelled > few) {
    add_lines(reference_of, mesh.edges, wide);
    add_whole(reference_of, mesh.triangles, wide);
    add_whole(reference_of, mesh.tetrahedra, wide);
  }
  for (std::size_t v = 0; v < marked.size(); ++v)
    marked[v] = reference_of[v] != 0 && !wide.contains(reference_of[v]);
  return marked;
}

}  // namespace ductile::meshadapt
