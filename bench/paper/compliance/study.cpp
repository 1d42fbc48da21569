#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ductile/meshadapt/files.hpp"
#include "picture/draw.hpp"
#include "shared/picture.hpp"
#include "shared/progress_line.hpp"
#include "shared/table.hpp"
#include "shared/vtu_series.hpp"

namespace ductile::paper {

using meshadapt::AnyField;
using meshadapt::AnyMesh;

namespace {

cli::Colour material_colour(double density) {
  return (1 - density) * cli::Colour{0.96, 0.96, 0.93} + density * cli::Colour{0.10, 0.18, 0.32};
}

/// A mesh with its density, kept until the picture is drawn.
struct Frame {
  std::string title;
  AnyMesh mesh;
  std::vector<double> density_of;
};

FieldPanel panel_of(const Frame& frame, bool lines) {
  return {.mesh = frame.mesh,
          .value_of = lines ? std::span<const double>{} : frame.density_of,
          .lines = lines,
          .title = frame.title,
          .window = {},
          .colour = material_colour};
}

/// Is the mesh of this iteration shown? Four are, more closely spaced at the beginning.
bool is_shown(int iteration, int iterations) {
  return iteration == iterations / 20 || iteration == iterations / 6 ||
         iteration == iterations / 2 || iteration == iterations - 1;
}

/// The text of a frame, e.g. "iteration 20: 4711 elements, compliance 60.88".
std::string words_for(const Iteration& found) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "iteration %d: %zu elements, compliance %.4g",
                found.number + 1, found.elements, found.compliance);
  return text.data();
}

/// Names such as "adapted_2d" are for files; readers see "adapted".
std::string title_of(const Outcome& outcome) {
  return outcome.name.substr(0, outcome.name.find('_')) + " mesh, " + words_for(outcome.last);
}

std::string report_of(const Iteration& found) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "%zu elements, compliance %.4f, sharpness %g",
                found.elements, found.compliance, found.sharpness);
  return text.data();
}

void add_to(Outcome& outcome, const Iteration& found) {
  outcome.last = found;
  outcome.seconds += found.seconds;
  outcome.adapt_seconds += found.adapt_seconds;
  outcome.solve_seconds += found.solve_seconds;
}

void add_to(Table& history, const Iteration& found) {
  history.add({static_cast<double>(found.number + 1), static_cast<double>(found.elements),
               found.sharpness, found.compliance, found.volume_fraction, found.change,
               found.adapt_seconds, found.solve_seconds, found.seconds});
}

/// The material part of a 3D mesh.
AnyMesh material_of(const Frame& frame) {
  AnyMesh solid = frame.mesh;
  solid.triangles = {};
  solid.tetrahedra = {};
  for (const auto& corners : frame.mesh.tetrahedra.vertices) {
    double sum = 0;
    for (const std::uint32_t v : corners) sum += frame.density_of[v];
    if (sum > 2) solid.tetrahedra.add(corners, 1);
  }
  return solid;
}

void draw_solids(const std::filesystem::path& path, const std::vector<Frame>& frames, int size) {
  cli::Scene scene;
  for (const Frame& frame : frames) {
    scene.panels.push_back(cli::surface_panel(material_of(frame), cli::camera_along(2)));
    scene.panels.back().title = frame.title;
  }
  meshadapt::AtomicOutputs outputs;
  write_bytes(outputs, path, cli::draw(scene, cli::PictureFormat::png, size));
  outputs.commit();
}

void draw_frames(const std::filesystem::path& path, const std::vector<Frame>& frames) {
  if (frames.front().mesh.dimension == 3) return draw_solids(path, frames, 400);
  std::vector<FieldPanel> panels;
  panels.reserve(2 * frames.size());
  for (const Frame& frame : frames) panels.push_back(panel_of(frame, false));
  for (const Frame& frame : frames) panels.push_back(panel_of(frame, true));
  const auto columns = static_cast<int>(frames.size());
  write_png(path, panels,
            {.columns = columns, .panel_width = 360, .bar = {"density", 0, 1, material_colour}});
}

}  // namespace

template <int Dim>
Outcome optimise(Experiment& experiment, const std::string& name, const Settings& settings) {
  Optimiser<Dim> optimiser(experiment.executor(), settings);
  ProgressLine progress;
  VtuSeries series(experiment.file(name + ".pvd"));
  Table history({"iteration", "elements", "sharpness", "compliance", "volume", "change",
                 "adapt_seconds", "solve_seconds", "seconds"});
  Outcome outcome{.name = name, .mesh = {}, .density_of = {}, .last = {}};
  std::vector<Frame> frames;
  for (int i = 0; i < settings.path.iterations; ++i) {
    const Iteration found = optimiser.iterate();
    add_to(outcome, found);
    add_to(history, found);
    progress.show((i + 1.0) / settings.path.iterations, name + ": " + report_of(found));
    if (is_shown(i, settings.path.iterations))
      frames.push_back({words_for(found), optimiser.mesh(), optimiser.density()});
    if (i % 10 == 9)
      series.add(i + 1, optimiser.mesh(),
                 {{"density", AnyField::Type::scalar, optimiser.density()},
                  {"derivative", AnyField::Type::scalar, optimiser.derivative()}});
  }
  history.write_csv(experiment.file(name + ".csv"));
  if (!frames.empty()) draw_frames(experiment.file(name + "_frames.png"), frames);
  outcome.mesh = optimiser.mesh();
  outcome.density_of = optimiser.density();
  return outcome;
}

template <>
void draw_outcomes<2>(Experiment& experiment, const std::string& name,
                      const std::vector<Outcome>& outcomes) {
  std::vector<Frame> frames;
  frames.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes)
    frames.push_back({title_of(outcome), outcome.mesh, outcome.density_of});
  std::vector<FieldPanel> panels;
  panels.reserve(2 * frames.size());
  for (const Frame& frame : frames) panels.push_back(panel_of(frame, false));
  for (const Frame& frame : frames) {
    panels.push_back(panel_of(frame, true));
    panels.back().title = "its mesh, x from 0.5 to 0.8, y from 0.15 to 0.3";
    panels.back().window = {0.5, 0.15, 0.8, 0.3};
  }
  write_png(experiment.file(name), panels,
            {.columns = static_cast<int>(frames.size()),
             .panel_width = 600,
             .bar = {"density", 0, 1, material_colour}});
}

template <>
void draw_outcomes<3>(Experiment& experiment, const std::string& name,
                      const std::vector<Outcome>& outcomes) {
  std::vector<Frame> frames;
  frames.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes)
    frames.push_back({title_of(outcome), outcome.mesh, outcome.density_of});
  draw_solids(experiment.file(name), frames, 700);
}

template Outcome optimise<2>(Experiment&, const std::string&, const Settings&);
template Outcome optimise<3>(Experiment&, const std::string&, const Settings&);

}  // namespace ductile::paper
