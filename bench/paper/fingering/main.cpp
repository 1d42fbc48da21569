/// @file
/// Viscous fingering: for now, only the mesh to start from.

#include <cmath>
#include <vector>

#include "ductile/meshadapt/make_mesh.hpp"
#include "shared/box_mesh.hpp"
#include "shared/experiment.hpp"
#include "shared/picture.hpp"
#include "shared/table.hpp"
#include "shared/vtu_series.hpp"

namespace {

using namespace ductile;

void run(paper::Experiment& experiment) {
  const meshadapt::AnyMesh mesh = paper::rectangle_mesh({2, 1}, {40, 20});
  const meshadapt::AnyMesh solid = paper::box_mesh({2, 1, 1}, {4, 3, 5});
  std::vector<std::string> warnings;
  meshadapt::Neighbours<3> neighbours;
  meshadapt::Neighbours<2> neighbours2;
  make_mesh<3>(experiment.executor(), solid, {}, neighbours, warnings);
  make_mesh<2>(experiment.executor(), mesh, {}, neighbours2, warnings);
  experiment.claim(warnings.empty(), "the meshes to start from are as they should be");
  std::vector<double> value_of;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    value_of.push_back(std::sin(5 * mesh.coordinates[2 * v]) * mesh.coordinates[2 * v + 1]);
  paper::write_png(experiment.file("start.png"),
                   {{.mesh = mesh, .value_of = value_of, .title = "a field"},
                    {.mesh = mesh, .lines = true, .title = "its mesh"},
                    {.mesh = mesh, .value_of = value_of, .lines = true},
                    {.mesh = mesh,
                     .value_of = value_of,
                     .lines = true,
                     .title = "close",
                     .window = {0.5, 0.5, 1, 0.7}}},
                   {.columns = 2, .panel_width = 400});
  paper::VtuSeries series(experiment.file("series.pvd"));
  series.add(0, mesh, {{"saturation", meshadapt::AnyField::Type::scalar, value_of}});
  paper::Table table({"time", "triangles"});
  table.add({0, static_cast<double>(mesh.triangles.size())});
  table.write_csv(experiment.file("mesh.csv"));
  experiment.say("%s", table.text().c_str());
}

}  // namespace

int main(int word_count, char** word) {
  return paper::run_experiment(word_count, word, {"Viscous fingering in a porous medium", run});
}
