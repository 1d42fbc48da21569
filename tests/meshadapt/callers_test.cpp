/// @file
/// Guarantees to programs that call adapt(): it can be cancelled, prints nothing, works in a forked
/// child, reports edges held by required entities, and finds sizes that a coarse mesh does not
/// show.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/hash.hpp"
#include "support/meshes.hpp"
#include "support/random_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::callers_test {
namespace {

using runtime::Executor;

AnyField sizes(const AnyMesh& mesh, double size) {
  return metric_of(scalar_field(mesh.dimension, std::vector<double>(mesh.vertex_count(), size)),
                   mesh);
}

// ---- Progress ----

TEST(Callers, MayCancelAfterAnyStep) {
  const Executor executor({.threads = 3});
  const AnyMesh mesh = box_mesh<2>({1, 1}, {8, 8});
  const AnyField metric = sizes(mesh, 0.06);
  const AnyMesh expected = adapt(executor, mesh, metric).mesh;
  int steps = 0, wanted = -1;
  const AdaptOptions options{.progress = [&](const AdaptProgress&) { return steps++ != wanted; }};
  EXPECT_EQ(adapt(executor, mesh, metric, options).mesh, expected);
  const int all = steps;
  EXPECT_GT(all, 4);
  for (wanted = 0; wanted < all; wanted += 3) {
    steps = 0;
    EXPECT_THROW(adapt(executor, mesh, metric, options), Cancelled) << wanted;
    EXPECT_EQ(steps, wanted + 1) << "progress was called after it had cancelled";
  }
  EXPECT_EQ(adapt(executor, mesh, metric).mesh, expected)
      << "a cancelled run has changed the next one";
}

TEST(Callers, GetWhatTheirProgressThrows) {
  const AnyMesh mesh = box_mesh<2>({1, 1}, {4, 4});
  const AdaptOptions options{
      .progress = [](const AdaptProgress&) -> bool { throw std::out_of_range("theirs"); }};
  EXPECT_THROW(adapt(Executor({.threads = 2}), mesh, sizes(mesh, 0.06), options),
               std::out_of_range);
}

// ---- Output ----

TEST(Callers, FindNothingPrinted) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  for (std::uint64_t seed = 0; seed < test::trials(8); ++seed) {
    const test::RandomCase random = test::random_case(seed);
    adapt(Executor({.threads = 2}), random.mesh, random.metric, random.options);
  }
  AnyMesh bad = box_mesh<2>({1, 1}, {2, 2});
  bad.triangles.vertices[0][0] = 77;
  EXPECT_THROW(adapt(Executor(), bad, sizes(bad, 0.1)), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// ---- Forked children ----

std::size_t hash_of(const AnyMesh& mesh) {
  const auto bytes = [](const auto& values) {
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])});
  };
  return bytes(mesh.coordinates) + 3 * bytes(mesh.triangles.vertices) +
         5 * bytes(mesh.edges.vertices);
}

/// The result of compute() in a forked child; 0 if the child does not return.
template <class Compute>
std::size_t in_child(const Compute& compute) {
  int ends[2];
  if (::pipe(ends) != 0) return 0;
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);
    std::size_t result = 0;
    try {
      result = compute();
    } catch (...) {
    }
    const bool written = ::write(ends[1], &result, sizeof result) == sizeof result;
    ::_exit(written ? 0 : 1);
  }
  ::close(ends[1]);
  std::size_t result = 0;
  if (::read(ends[0], &result, sizeof result) != sizeof result) result = 0;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return result;
}

TEST(Callers, MayForkAndAdaptInTheChild) {
  const Executor executor({.threads = 4});
  const AnyMesh mesh = box_mesh<2>({1, 1}, {20, 20});
  const AnyField metric = sizes(mesh, 0.03);
  const auto work = [&] { return hash_of(adapt(executor, mesh, metric).mesh); };
  const std::size_t expected = work();  // on threads that the children do not have
  EXPECT_EQ(in_child(work), expected);
  EXPECT_EQ(in_child([&] { return in_child(work); }), expected) << "child of a child";
  bool done = false;  // a child is forked during an adaptation, by the leader of its team
  const AdaptOptions options{.progress = [&](const AdaptProgress&) {
    if (!std::exchange(done, true)) {
      EXPECT_EQ(in_child(work), expected);
    }
    return true;
  }};
  EXPECT_EQ(hash_of(adapt(executor, mesh, metric, options).mesh), expected);
  EXPECT_EQ(work(), expected);
}

// ---- Required entities ----

template <int N>
void add_edges(const Cells<N>& cells, const std::vector<std::uint32_t>& required,
               std::set<std::pair<VertexId, VertexId>>& edges) {
  for (const std::uint32_t i : required)
    for (const VertexId a : cells.vertices[i])
      for (const VertexId b : cells.vertices[i])
        if (a < b) edges.emplace(a, b);
}

template <int Dim>
std::size_t long_edges(const AdaptedMesh& adapted,
                       const std::set<std::pair<VertexId, VertexId>>& edges) {
  const auto site = [&](VertexId v) {
    Metric<Dim> metric;
    std::copy_n(&adapted.metric.values[v * metric.m.size()], metric.m.size(), metric.m.begin());
    return make_site<Dim>(position_in<Dim>(adapted.mesh, v), metric);
  };
  return static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(), [&](const auto& edge) {
    return edge_length(site(edge.first), site(edge.second)) > Rules().long_edge;
  }));
}

TEST(Callers, GetToKnowHowManyLongEdgesRequiredEntitiesHold) {
  std::size_t held = 0;
  for (std::uint64_t seed = 0; seed < test::trials(20); ++seed) {
    const test::RandomCase random = test::random_case(seed);
    if (random.options.make.lock_boundary) continue;  // locks facets that are not listed, too
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.what);
    const AdaptedMesh adapted =
        adapt(Executor({.threads = 2}), random.mesh, random.metric, random.options);
    std::set<std::pair<VertexId, VertexId>> edges;
    add_edges(adapted.mesh.edges, adapted.mesh.required_edges, edges);
    add_edges(adapted.mesh.triangles, adapted.mesh.required_triangles, edges);
    add_edges(adapted.mesh.tetrahedra, adapted.mesh.required_tetrahedra, edges);
    EXPECT_EQ(adapted.report.held_long_edges, random.mesh.dimension == 2
                                                  ? long_edges<2>(adapted, edges)
                                                  : long_edges<3>(adapted, edges));
    held += adapted.report.held_long_edges;
  }
  if (test::trials(20) >= 20) {
    EXPECT_GT(held, 100U);  // fewer trials need not reach it
  }
}

TEST(Callers, GetToKnowHowManyShortEdgesRequiredEntitiesHold) {
  const Executor executor({.threads = 2});
  AnyMesh mesh = box_mesh<2>({1, 1}, {40, 40});
  const AnyField metric = sizes(mesh, 0.2);
  EXPECT_EQ(adapt(executor, mesh, metric).report.held_short_edges, 0U) << "no edge is required yet";
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.edges.reference[e] == Side::left) mesh.required_edges.push_back(e);
  const AdaptReport report = adapt(executor, mesh, metric).report;
  EXPECT_GE(report.held_short_edges, 40U);  // edges of the side, and a few others
  EXPECT_LE(report.held_short_edges, 50U);
  EXPECT_EQ(report.held_long_edges, 0U);
  const AnyMesh box = box_mesh<3>({1, 1, 1}, {4, 4, 4});
  const AdaptReport locked =
      adapt(executor, box, sizes(box, 0.1), {.make = {.lock_boundary = true}}).report;
  EXPECT_EQ(locked.held_long_edges, 288U) << "of 192 triangles";
  EXPECT_EQ(locked.held_short_edges, 0U);
}

// ---- Sizes by places ----

/// A coarse mesh with a size near a place that is far from all vertices, or at a vertex.
struct HiddenSize {
  AnyMesh mesh;
  Sizes sizes;
  Vector<3> at;
  double size = 0;
};

HiddenSize random_hidden_size(std::uint64_t seed) {
  test::Random random(seed);
  HiddenSize hidden;
  const std::size_t kind = test::below(random, 5);
  const int d = seed % 2 == 0 ? 2 : 3;
  const int n = kind < 3 ? 1 + static_cast<int>(test::below(random, 3)) : d == 2 ? 12 : 4;
  hidden.mesh = d == 2 ? box_mesh<2>({1, 1}, {n, n}) : box_mesh<3>({1, 1, 1}, {n, n, n});
  hidden.size = d == 2 ? test::uniform(random, 0.01, 0.04) : test::uniform(random, 0.08, 0.12);
  hidden.sizes.elsewhere = 0.5;
  for (int axis = 0; axis < d; ++axis) hidden.at[axis] = test::uniform(random, 0.2, 0.8);
  SizePlace place = Ball{hidden.at, 0};
  if (kind == 1) place = AxisBox{hidden.at, hidden.at + Vector<3>{{0.02, 0.01, 0.01}}};
  if (kind == 2) place = Polyline{{hidden.at, hidden.at + Vector<3>{{0.05, 0.05, 0}}}};
  if (kind >= 3) {  // a vertex of a mesh that is too fine, which may be removed
    const std::size_t vertex = test::below(random, hidden.mesh.vertex_count());
    for (int axis = 0; axis < d; ++axis)
      hidden.at[axis] =
          hidden.mesh
              .coordinates[vertex * static_cast<std::size_t>(d) + static_cast<std::size_t>(axis)];
    hidden.mesh.vertex_reference[vertex] = 9;
    hidden.mesh.names = {{0, 9, "spot"}, {d, 1, "spot"}};
    hidden.size = 0.3;
    place = Referenced{0, 9};
    if (kind == 4) place = Named{"spot"};  // the name also covers all elements
  }
  hidden.sizes.add(place, hidden.size);
  return hidden;
}

/// The longest edge of the elements around the vertex nearest to a place.
template <int Dim>
double longest_edge_near(const AnyMesh& mesh, const Vector<3>& place) {
  Vector<Dim> at;
  for (int axis = 0; axis < Dim; ++axis) at[axis] = place[axis];
  VertexId nearest = 0;
  const auto distance = [&](VertexId v) { return norm(position_in<Dim>(mesh, v) - at); };
  for (VertexId v = 0; v < mesh.vertex_count(); ++v)
    if (distance(v) < distance(nearest)) nearest = v;
  double longest = 0;
  for (const auto& corners : elements_in<Dim>(mesh).vertices)
    if (std::find(corners.begin(), corners.end(), nearest) != corners.end())
      for (const VertexId a : corners)
        for (const VertexId b : corners)
          longest = std::max(longest, norm(position_in<Dim>(mesh, a) - position_in<Dim>(mesh, b)));
  return longest;
}

double longest_edge_near(const AnyMesh& mesh, const Vector<3>& place) {
  return mesh.dimension == 2 ? longest_edge_near<2>(mesh, place)
                             : longest_edge_near<3>(mesh, place);
}

TEST(Callers, MeetSizesThatACoarseMeshDidNotShow) {
  const Executor one({.threads = 1}), two({.threads = 2});
  constexpr double near = 3;  // in units of the size, which grows from the place
  std::size_t missed = 0;
  for (std::uint64_t seed = 0; seed < test::trials(16); ++seed) {
    SCOPED_TRACE(seed);
    const auto [mesh, sizes, at, size] = random_hidden_size(seed);
    const AdaptedMesh adapted = adapt_to_sizes(two, mesh, sizes);
    EXPECT_EQ(check_adapted(two, mesh, adapted.mesh), std::vector<std::string>{});
    EXPECT_LT(longest_edge_near(adapted.mesh, at), near * size);
    if (seed < 6) {
      EXPECT_EQ(adapt_to_sizes(one, mesh, sizes).mesh, adapted.mesh);
    }
    const AnyField seen = metric_of(size_field(two, mesh, sizes), mesh);
    missed += longest_edge_near(adapt(two, mesh, seen).mesh, at) > near * size ? 1 : 0;
  }
  if (test::trials(16) >= 24) {
    EXPECT_GT(missed, 3U) << "a single adapt() finds the sizes, too, so the test proves nothing";
  }
}

TEST(Callers, GetWarningsOfEachTimeAndMayCancelAnyTime) {
  AnyMesh mesh = box_mesh<2>({1, 1}, {2, 2});
  Sizes sizes{.elsewhere = 0.5};
  sizes.add(Ball{{0.3, 0.6}, 0}, 0.01);
  std::swap(mesh.triangles.vertices[0][0], mesh.triangles.vertices[0][1]);  // inverted
  const Executor executor({.threads = 2});
  int falls = 0, last = 0;
  AdaptOptions options{.progress = [&](const AdaptProgress& now) {
    falls += now.iteration < last ? 1 : 0;
    last = now.iteration;
    return true;
  }};
  const AdaptReport report = adapt_to_sizes(executor, mesh, sizes, options).report;
  EXPECT_EQ(report.warnings.size(), 1U);
  EXPECT_GE(falls, 1) << "progress was reported for one adaptation only";
  int steps = 0;
  options.progress = [&](const AdaptProgress&) { return ++steps < 40; };
  EXPECT_THROW(adapt_to_sizes(executor, mesh, sizes, options), Cancelled);
  EXPECT_EQ(steps, 40);
  sizes.add(Ball{{0.3, 0.6}, -1}, 0.01);
  EXPECT_THROW(adapt_to_sizes(executor, mesh, sizes), InputError);
  // Adapts again also if boundaries may move, but only once if the mesh shows all sizes.
  falls = last = 0;
  options.progress = [&](const AdaptProgress& now) {
    falls += now.iteration < last ? 1 : 0;
    last = now.iteration;
    return true;
  };
  options.make.hausdorff_tolerance = 0.01;
  sizes.sources.pop_back();
  adapt_to_sizes(executor, mesh, sizes, options);
  EXPECT_GE(falls, 1);
  options.progress = {};
  options.make.hausdorff_tolerance = 0;
  options.largest_size = 0.1;  // finer than the sizes
  const Sizes even{.elsewhere = 0.2};
  EXPECT_EQ(adapt_to_sizes(executor, mesh, even, options).mesh,
            adapt(executor, mesh, metric_of(size_field(executor, mesh, even), mesh), options).mesh);
}

}  // namespace
}  // namespace ductile::meshadapt::callers_test
