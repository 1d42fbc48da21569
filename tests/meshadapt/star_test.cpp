#include "operators/star.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::star_test {
namespace {

const runtime::Executor executor({.threads = 1});

/// A grid whose elements have random qualities and epochs.
Mesh<3> random_grid(test::Random& random) {
  const AnyMesh any = test::make_grid(test::unit_grid(3, 4));
  Neighbours<3> neighbours;
  std::vector<std::string> warnings;
  auto mesh = make_mesh<3>(executor, any, {}, neighbours, warnings);
  for (std::size_t e = 0; e < mesh.element_slots(); ++e) {
    mesh.quality_of[e] = static_cast<float>(test::uniform(random, 0, 1));
    mesh.changed_at[e] = static_cast<std::uint32_t>(test::below(random, 8));
  }
  return mesh;
}

/// Number of elements around an edge that each vertex belongs to.
std::map<VertexId, int> counts_around(const Mesh<3>& mesh, const Shell& shell) {
  std::map<VertexId, int> counts;
  for (const ElementId e : shell)
    for (const VertexId v : mesh.corners_of[e]) ++counts[v];
  return counts;
}

void expect_edge(const Mesh<3>& mesh, const Star& star, VertexId vertex, std::size_t i) {
  const Star::Edge& edge = star.edge(i);
  Shell shell;
  shell_of(mesh, vertex, edge.to, shell);
  ASSERT_EQ(edge.count, shell.size());
  ASSERT_LE(shell.size(), Star::most_around);
  const auto ball = mesh.elements_of.of(vertex);
  ElementId worst = shell[0];
  bool changed = false, inside = true;
  for (std::size_t k = 0; k < shell.size(); ++k) {
    EXPECT_EQ(ball[star.around(i)[k]], shell[k]);
    if (mesh.quality_of[shell[k]] < mesh.quality_of[worst]) worst = shell[k];
    changed = changed || mesh.changed_at[shell[k]] > 6;
  }
  for (const auto& [v, count] : counts_around(mesh, shell))
    inside = inside && (count == 2 || v == vertex || v == edge.to);
  EXPECT_EQ(ball[edge.worst], worst);
  EXPECT_EQ(edge.worst_quality, mesh.quality_of[worst]);
  EXPECT_EQ(edge.changed, changed);
  EXPECT_EQ(edge.ends == 0, inside);
}

TEST(Star, KnowsWhatIsAroundEachEdgeToAHigherVertex) {
  test::Random random(31);
  const auto mesh = random_grid(random);
  std::size_t edges = 0;
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    const Star star(mesh, v, 6);
    const auto neighbours = neighbours_of(mesh, v);
    EXPECT_EQ(star.size(),
              static_cast<std::size_t>(std::count_if(neighbours.begin(), neighbours.end(),
                                                     [&](VertexId n) { return n > v; })));
    for (std::size_t i = 0; i < star.size(); ++i) {
      EXPECT_GT(star.edge(i).to, v);
      expect_edge(mesh, star, v, i);
    }
    edges += star.size();
  }
  EXPECT_GT(edges, 500U);
}

}  // namespace
}  // namespace ductile::meshadapt::star_test
