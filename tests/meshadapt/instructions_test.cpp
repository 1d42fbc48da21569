/// @file
/// Functions with AVX-512 must give the same bytes as those as built, wherever they are called.
#include "core/instructions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "adapt/adapter.hpp"
#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "geometry/make_mesh.hpp"
#include "operators/edges.hpp"
#include "operators/smooth.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/random_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::instructions_test {
namespace {

using runtime::Executor;
using test::bits;

/// A random case of this dimension, as kernels get it.
template <int Dim>
struct Scene {
  test::RandomCase random;
  Mesh<Dim> mesh;
  Neighbours<Dim> neighbours;
  std::vector<Metric<Dim>> metric_of;

  Scene(const Executor& executor, std::uint64_t seed) : random(test::random_case(seed)) {
    std::vector<std::string> warnings;
    mesh = make_mesh<Dim>(executor, random.mesh, random.options.make, neighbours, warnings);
    metric_of.resize(random.mesh.vertex_count());
    for (std::size_t v = 0; v < metric_of.size(); ++v)
      std::copy_n(&random.metric.values[v * Metric<Dim>::size], Metric<Dim>::size,
                  metric_of[v].m.begin());
  }
  /// Gives the vertices their metrics, as an Adapter does.
  void set_metrics(const Executor& executor) {
    for (std::size_t v = 0; v < metric_of.size(); ++v) {
      mesh.site_of[v] = make_site(mesh.site_of[v].position, metric_of[v]);
      mesh.host_of[v] = mesh.elements_of.of(static_cast<VertexId>(v)).front();
    }
    update_qualities(executor, mesh);
  }
};

/// Compares floats by their bits, so that -0 is not 0; the warning is for classes with padding, of
/// which there are none.
template <class Item>
bool same_bytes(const Item& a, const Item& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;  // NOLINT(bugprone-suspicious-memory-comparison)
}

/// Both dimensions; even seeds of random_case() are 2D, odd ones 3D.
template <class Dimension>
class InstructionsIn : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;
  void SetUp() override {
    if (best_instructions() == Instructions::as_built)
      GTEST_SKIP() << "this build or this processor has no AVX-512";
  }
  /// Calls check(seed) with seeds of random cases.
  void for_random(int most, auto&& check) const {
    const auto first = test::first_trial(40), end = first + test::trials(most);
    for (std::uint64_t trial = first; trial < end; ++trial) {
      const std::uint64_t seed = 2 * trial + (Dim == 3 ? 1 : 0);
      SCOPED_TRACE("seed " + std::to_string(seed) + ": " + test::random_case(seed).what);
      check(seed);
    }
  }
  const Executor executor_{{.threads = 2}};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(InstructionsIn, Dimensions);

TYPED_TEST(InstructionsIn, MovesAreTheSame) {
  constexpr int Dim = TypeParam::value;
  std::size_t moves = 0;
  this->for_random(12, [&](std::uint64_t seed) {
    Scene<Dim> scene(this->executor_, seed);
    scene.set_metrics(this->executor_);
    Mesh<Dim>& mesh = scene.mesh;
    const Background<Dim> background(this->executor_, mesh, std::move(scene.neighbours));
    for (const bool laplacian : {true, false}) {
      const Smooth<Dim> op(mesh, background, {.laplacian = laplacian, .mean_below = 0.9});
      for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
        if (mesh.kind_of[v].class_dimension == 0) continue;
        VertexMove<Dim> plain{}, wide{};
        mesh.instructions = Instructions::as_built;
        const bool moved = op.decide(v, plain);
        mesh.instructions = best_instructions();
        ASSERT_EQ(op.decide(v, wide), moved) << "vertex " << v;
        ASSERT_TRUE(same_bytes(plain.site, wide.site)) << "vertex " << v;
        ASSERT_TRUE(same_bytes(plain.qualities, wide.qualities)) << "vertex " << v;
        ASSERT_TRUE(plain == wide) << "vertex " << v;
        moves += moved;
      }
    }
  });
  EXPECT_GT(moves, 500U);
}

TYPED_TEST(InstructionsIn, LengthsAreTheSame) {
  constexpr int Dim = TypeParam::value;
  std::size_t edges = 0;
  this->for_random(12, [&](std::uint64_t seed) {
    Scene<Dim> scene(this->executor_, seed);
    scene.set_metrics(this->executor_);
    scene.mesh.epoch = 2;
    const auto edges_with = [&](Instructions instructions) {
      scene.mesh.instructions = instructions;
      EdgeSurvey<Dim> survey({.shorter = 0.9, .longer = 1.2});
      auto found = std::pair(long_edges(this->executor_, scene.mesh, survey, 1.2, 0),
                             std::vector<std::array<std::size_t, 2>>());
      constexpr std::size_t stretch = EdgeSurvey<Dim>::stretch;
      for (std::size_t e = 0; e < scene.mesh.element_slots(); e += stretch)
        survey.visit_shorter(scene.mesh, e, [&](ElementId element, std::size_t edge) {
          found.second.push_back({element, edge});
        });
      return found;
    };
    const auto plain = edges_with(Instructions::as_built), wide = edges_with(best_instructions());
    EXPECT_TRUE(std::ranges::equal(plain.first, wide.first));
    EXPECT_EQ(plain.second, wide.second);
    edges += plain.first.size() + plain.second.size();
  });
  EXPECT_GT(edges, 500U);
}

TYPED_TEST(InstructionsIn, AdaptedMeshesAreTheSame) {
  constexpr int Dim = TypeParam::value;
  this->for_random(Dim == 2 ? 6 : 3, [&](std::uint64_t seed) {
    const auto adapted_with = [&](Instructions instructions) {
      Scene<Dim> scene(this->executor_, seed);
      scene.mesh.instructions = instructions;
      AdaptReport report;
      Adapter<Dim> adapter(
          this->executor_, scene.random.options,
          {std::move(scene.mesh), std::move(scene.neighbours), std::move(scene.metric_of)}, report);
      adapter.run(Effort::everything);
      EXPECT_EQ(adapter.mesh().instructions, instructions);
      return take_apart(this->executor_, adapter.take_mesh());
    };
    const MeshWithMetric plain = adapted_with(Instructions::as_built),
                         wide = adapted_with(best_instructions());
    EXPECT_EQ(bits(plain.mesh.coordinates), bits(wide.mesh.coordinates));
    EXPECT_TRUE(plain.mesh == wide.mesh);
    EXPECT_EQ(bits(plain.metric.values), bits(wide.metric.values));
  });
}

TEST(Instructions, AreTheBestAndAreReported) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(2, 3));
  EXPECT_EQ(adapt(Executor({.threads = 1}), mesh, constant_metric(mesh, 0.3)).report.instructions,
            name_of(best_instructions()));
#if defined(__linux__) && defined(DUCTILE_HAS_AVX512)
  std::ifstream cpus("/proc/cpuinfo");
  const std::string text{std::istreambuf_iterator<char>(cpus), {}};
  for (const char* feature : {" avx512f", " avx512bw", " avx512cd", " avx512dq", " avx512vl"})
    if (text.find(feature) == std::string::npos) {
      EXPECT_EQ(best_instructions(), Instructions::as_built) << "without" << feature;
    }
#endif
}

}  // namespace
}  // namespace ductile::meshadapt::instructions_test
