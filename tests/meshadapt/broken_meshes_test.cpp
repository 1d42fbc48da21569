/// @file
/// Calls every public function that takes a mesh with randomly broken meshes. It must refuse them
/// by an InputError that names an array and mentions no file or option, and never crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "geometry/make_mesh.hpp"
#include "operators/background.hpp"
#include "support/broken_input.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::broken_meshes_test {
namespace {

using test::bad_index;
using test::below;
using test::chance;
using test::change_length;
using test::expect_refused;
using test::expect_survived;
using test::Folder;
using test::no_number;
using test::Random;
using test::small_mesh;
using test::uniform;

const runtime::Executor executor({.threads = 1});

template <class Dimension>
class BrokenMeshesIn : public testing::Test {};
TYPED_TEST_SUITE(BrokenMeshesIn, test::Dimensions, );

/// The broken part of a mesh, which decides which functions can detect it.
enum class Part { vertices, positions, elements, references, facets, lists };

template <class Cells>
void break_index(Random& random, Cells& cells, std::size_t limit) {
  auto& corners = cells.vertices[below(random, cells.size())];
  corners[below(random, corners.size())] = bad_index(random, limit);
}

template <int Dim>
AnyMesh broken_mesh(Random& random, Part part) {
  AnyMesh mesh = small_mesh<Dim>();
  const std::size_t vertices = mesh.vertex_count();
  switch (part) {
    case Part::vertices:
      if (chance(random, 0.2))
        mesh.dimension = static_cast<int>(below(random, 9)) - 3 == Dim ? 7 : 0;
      else if (chance(random, 0.5))
        change_length(random, mesh.coordinates);
      else
        change_length(random, mesh.vertex_reference);
      break;
    case Part::positions:
      mesh.coordinates[below(random, vertices * Dim)] = no_number(random);
      break;
    case Part::elements:
      break_index(random, elements_in<Dim>(mesh), vertices);
      break;
    case Part::references:
      change_length(random, elements_in<Dim>(mesh).reference);
      break;
    case Part::facets:
      if (chance(random, 0.5))
        break_index(random, facets_in<Dim>(mesh), vertices);
      else
        change_length(random, facets_in<Dim>(mesh).reference);
      break;
    case Part::lists: {
      std::vector<std::uint32_t>* const lists[] = {
          &mesh.corners, &mesh.required_vertices, &mesh.required_edges, &mesh.ridges,
          Dim == 2 ? &mesh.required_triangles : &mesh.required_tetrahedra};
      lists[below(random, 5)]->push_back(bad_index(random, 100000));
      break;
    }
  }
  return mesh;
}

/// A function of a mesh, and the parts of the mesh that it reads.
struct OfMesh {
  const char* name;
  std::function<void(const AnyMesh&)> call;
  std::set<Part> looks_at;
};

using PartSet = std::set<Part>;
const PartSet of_geometry{Part::vertices, Part::positions, Part::elements};
const PartSet of_domain{Part::vertices, Part::elements, Part::references, Part::facets};
const PartSet all_parts{Part::vertices,   Part::positions, Part::elements,
                        Part::references, Part::facets,    Part::lists};

/// Functions that make metrics and meshes from a mesh, check it or measure it.
template <int Dim>
std::vector<OfMesh> functions_of_meshes() {
  const auto whole = std::make_shared<AnyMesh>(small_mesh<Dim>());
  const auto metric = std::make_shared<AnyField>(constant_metric(*whole, 0.4));
  return {
      {"adapt", [=](const AnyMesh& m) { adapt(executor, m, *metric); }, all_parts},
      {"constant_metric", [](const AnyMesh& m) { constant_metric(m, 0.1); }, {Part::vertices}},
      {"default_metric",
       [](const AnyMesh& m) { default_metric(executor, m); },
       {Part::vertices, Part::elements}},
      {"implied_metric",
       [](const AnyMesh& m) { implied_metric(m); },
       {Part::vertices, Part::elements}},
      {"implied_tensors", [](const AnyMesh& m) { implied_tensors(executor, m); }, of_geometry},
      {"make_fixed_mesh", [](const AnyMesh& m) { make_fixed_mesh<Dim>(executor, m); }, of_geometry},
      {"make_mesh",
       [](const AnyMesh& m) {
         Neighbours<Dim> neighbours;
         Warnings warnings;
         make_mesh<Dim>(executor, m, {}, neighbours, warnings);
       },
       all_parts},
      {"check_domain, before", [=](const AnyMesh& m) { check_domain(executor, m, *whole); },
       of_domain},
      {"check_domain, after", [=](const AnyMesh& m) { check_domain(executor, *whole, m, 0.1); },
       of_domain},
      {"check_boundary", [](const AnyMesh& m) { check_boundary(executor, m); }, {Part::vertices}},
      {"measure", [](const AnyMesh& m) { measure(executor, m, nullptr); }, of_geometry},
      {"measure in a metric", [=](const AnyMesh& m) { measure(executor, m, metric.get()); },
       of_geometry},
      {"element_qualities", [](const AnyMesh& m) { element_qualities(executor, m, nullptr); },
       of_geometry},
      {"metric_of", [=](const AnyMesh& m) { metric_of(*metric, m); }, {Part::vertices}},
  };
}

/// Functions that also take fields, and functions that write the mesh.
template <int Dim>
std::vector<OfMesh> functions_of_meshes_and_more(const std::filesystem::path& folder) {
  const auto scalars = [](const AnyMesh& mesh) {
    return AnyField{mesh.dimension,
                    mesh.vertex_count(),
                    {AnyField::Type::scalar},
                    std::vector<double>(mesh.vertex_count(), 0.5),
                    ""};
  };
  const auto on_elements = [](const AnyMesh& mesh) {
    std::vector<NamedField> fields(1);
    fields[0] = {"f", AnyField::Type::scalar, {}, NamedField::Place::elements};
    fields[0].values.assign(elements_in<Dim>(mesh).size(), 0.5);
    return fields;
  };
  const PartSet of_cells{Part::vertices, Part::positions, Part::elements, Part::references,
                         Part::facets};
  const auto whole = std::make_shared<AnyMesh>(small_mesh<Dim>());
  return {
      {"recover_hessian", [=](const AnyMesh& m) { recover_hessian(executor, m, scalars(m)); },
       of_geometry},
      {"solution_metric",
       [=](const AnyMesh& m) {
         solution_metric(executor, m, scalars(m), {.goal = {.complexity = 10}});
       },
       of_geometry},
      {"interpolate_field, from",
       [=](const AnyMesh& m) {
         interpolate_field(executor, {m, scalars(m)}, *whole);
       },
       of_geometry},
      {"interpolate_field, to",
       [=](const AnyMesh& m) {
         interpolate_field(executor, {*whole, scalars(*whole)}, m);
       },
       of_geometry},
      {"project_field, to",
       [=](const AnyMesh& m) {
         project_field(executor, {*whole, scalars(*whole)}, m);
       },
       of_geometry},
      {"transfer_fields, from",
       [=](const AnyMesh& m) {
         transfer_fields(executor, {m, on_elements(m)}, *whole);
       },
       of_geometry},
      {"transfer_fields, to",
       [=](const AnyMesh& m) {
         transfer_fields(executor, {*whole, on_elements(*whole)}, m, {Carrying::conservatively});
       },
       of_geometry},
      {"origins, before", [=](const AnyMesh& m) { origins(executor, m, *whole); }, of_cells},
      {"origins, after", [=](const AnyMesh& m) { origins(executor, *whole, m); }, of_cells},
      {"list_boundary", [](AnyMesh m) { list_boundary(executor, m); }, of_cells},
      {"write_mesh", [=](const AnyMesh& m) { write_mesh(folder / "m.meshb", m); }, all_parts},
      {"write_mesh, vtu", [=](const AnyMesh& m) { write_mesh(folder / "m.vtu", m); }, of_cells},
  };
}

TYPED_TEST(BrokenMeshesIn, MeshesAreRefused) {
  constexpr int Dim = TypeParam::value;
  const Folder folder;
  std::vector<OfMesh> functions = functions_of_meshes<Dim>();
  std::ranges::move(functions_of_meshes_and_more<Dim>(folder.path), std::back_inserter(functions));
  for (const auto& [name, call, looks_at] : functions) {
    Random random(1);
    for (int i = 0; i < 120; ++i) {
      const auto part = static_cast<Part>(i % 6);
      const AnyMesh mesh = broken_mesh<Dim>(random, part);
      const std::string what = std::string(name) + ", part " + std::to_string(i % 6);
      if (looks_at.contains(part))
        expect_refused([&, &call = call] { call(mesh); }, what);
      else
        expect_survived([&, &call = call] { call(mesh); }, what);
    }
  }
}

TYPED_TEST(BrokenMeshesIn, CheckMeshSaysThatAMeshIsBroken) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const auto part = static_cast<Part>(i % 6);
    const AnyMesh mesh = broken_mesh<Dim>(random, part);
    expect_survived([&] { EXPECT_FALSE(check_mesh(executor, mesh).empty()) << i % 6; },
                    "check_mesh");
  }
}

/// The walk starts anywhere and looks for any point.
TYPED_TEST(BrokenMeshesIn, AWalkLeavesNoArray) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = small_mesh<Dim>();
  Neighbours<Dim> neighbours;
  Warnings warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
  for (std::size_t v = 0; v < mesh.vertex_slots(); ++v)
    mesh.site_of[v] = make_site(mesh.site_of[v].position, isotropic<Dim>(0.4));
  const Background<Dim> background(executor, mesh, std::move(neighbours));
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    Vector<Dim> point;
    for (double& x : point.x)
      x = chance(random, 0.3) ? no_number(random)
                              : uniform(random, -2, 2) * std::pow(10, uniform(random, -300, 300));
    const auto near = chance(random, 0.3)
                          ? bad_index(random, background.element_count())
                          : static_cast<ElementId>(below(random, background.element_count()));
    EXPECT_LT(background.sample(point, near).host, background.element_count());
  }
}

}  // namespace
}  // namespace ductile::meshadapt::broken_meshes_test
