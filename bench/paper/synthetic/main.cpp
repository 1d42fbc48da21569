/// @file
/// The synthetic benchmark: a mesh that follows a moving front, in the unit square and cube. How
/// long each kernel takes on 1, 2, 4, ... threads, and how the interpolation error falls with the
/// number of elements.

#include <array>
#include <cmath>
#include <cstdio>

#include "cases/psi.hpp"
#include "ductile/meshadapt/atomic_file.hpp"
#include "picture/draw.hpp"
#include "shared/picture.hpp"
#include "shared/progress_line.hpp"
#include "shared/vtu_series.hpp"
#include "tables.hpp"

namespace {

using namespace ductile;
using meshadapt::AnyMesh;
using paper::Experiment;

constexpr std::array<cli::Option, 5> options{{
    {"--dimension", "2|3", "only this one (default: both)"},
    {"--full", "",
     "times the paper's sizes: from 200 x 200 cells to 550,000 triangles, from 50^3 to 210,000 "
     "tetrahedra, 50 steps"},
    {"--elements", "N", "of the meshes that are timed (default: 60000, 3D: 40000)"},
    {"--steps", "N", "of time (default: 25, 3D: 8)"},
    {"--part", "errors|kernels", "only this one (default: both)"},
}};

struct Size {
  double elements = 0;
  int steps = 0;
  int start_cells = 0;  ///< along each axis of the mesh to start from; 0: of as many elements
};

Size usual_size(const Experiment& experiment, int dimension) {
  if (experiment.small()) return dimension == 2 ? Size{2000, 4} : Size{3000, 4};
  return dimension == 2 ? Size{60000, 25} : Size{40000, 8};
}

/// What the paper ran.
Size paper_size(int dimension) {
  return dimension == 2 ? Size{550000, 50, 200} : Size{210000, 50, 50};
}

Size size_of_march(const Experiment& experiment, int dimension) {
  const bool full = experiment.arguments().has("--full");
  const Size usual = full ? paper_size(dimension) : usual_size(experiment, dimension);
  const cli::Arguments& given = experiment.arguments();
  return {given.positive("--elements").value_or(usual.elements),
          given.integer("--steps", 1, 10000).value_or(usual.steps), usual.start_cells};
}

paper::MeshGoal goal_of(int dimension, double elements) {
  paper::MeshGoal goal{.elements = elements};
  if (dimension == 3) {
    goal.smallest = 1e-4;
    goal.anisotropy = 100;
  }
  return goal;
}

// ---- What a march leaves to look at ----

/// A mesh of the march, kept until the picture is drawn.
struct Frame {
  int step = 0;
  double phase = 0;
  AnyMesh mesh;
  std::vector<double> value_of;
};

std::string title_of(const Frame& frame) {
  return "step " + std::to_string(frame.step + 1) + ": " +
         std::to_string(paper::element_count(frame.mesh)) + " elements";
}

/// A small square on the jump, at x = 0.15.
paper::Window window_on_jump(double phase) {
  constexpr double x = 0.15, step = 0.01, half = 0.08;
  double y = half;
  while (y < 1 - half &&
         bench::psi_jump_level(x, y, phase) * bench::psi_jump_level(x, y + step, phase) > 0)
    y += step;
  return {x - half, y - half, x + half, y + half};
}

std::string words_for(const paper::Window& window) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "x from %.2f to %.2f, y from %.2f to %.2f", window.left,
                window.right, window.bottom, window.top);
  return text.data();
}

void draw_plane(Experiment& experiment, const std::vector<Frame>& frames) {
  std::vector<paper::FieldPanel> panels;
  panels.reserve(3 * frames.size());
  for (const Frame& frame : frames)
    panels.push_back({frame.mesh, frame.value_of, -1.6, 1.6, false, title_of(frame)});
  for (const Frame& frame : frames) {
    const paper::Window window = window_on_jump(frame.phase);
    panels.push_back(
        {.mesh = frame.mesh, .lines = true, .title = words_for(window), .window = window});
  }
  write_png(experiment.file("frames_2d.png"), panels,
            {.columns = static_cast<int>(frames.size()),
             .panel_width = 300,
             .bar = {"psi, in the unit square", -1.6, 1.6}});
}

void draw_solid(Experiment& experiment, const Frame& frame) {
  const cli::Scene scene = cli::make_scene(experiment.executor(), frame.mesh, nullptr,
                                           {.tint = cli::Tint::size, .cut_axis = 2});
  meshadapt::AtomicOutputs outputs;
  outputs.stage(experiment.file("cut_3d.png"))
      .write(cli::draw(scene, cli::PictureFormat::png, 700));
  outputs.commit();
}

/// Keeps some frames and writes some to the series.
class Watcher {
 public:
  Watcher(Experiment& experiment, const std::string& name, int steps)
      : series_(experiment.file(name + ".pvd")), name_(name), steps_(steps) {}

  void look(int step, double phase, const AnyMesh& mesh) {
    progress_.show((step + 1.0) / steps_,
                   name_ + ": " + std::to_string(paper::element_count(mesh)) + " elements");
    std::vector<double> value_of = paper::sampled_solution(mesh, phase).values;
    if (step % std::max(1, steps_ / 10) == 0)
      series_.add(phase, mesh, {{"psi", meshadapt::AnyField::Type::scalar, value_of}});
    if ((step + 1) * 3 / steps_ > step * 3 / steps_) {
      frames_.push_back({step, phase, mesh, std::move(value_of)});
      frames_.back().mesh.name = name_ + ", step " + std::to_string(step + 1);
    }
  }
  const std::vector<Frame>& frames() const { return frames_; }

 private:
  paper::ProgressLine progress_;
  paper::VtuSeries series_;
  std::string name_;
  int steps_;
  std::vector<Frame> frames_;
};

// ---- The two halves of the benchmark ----

/// 1, 2, 4, ... and the last one.
std::vector<int> thread_counts(int last) {
  std::vector<int> counts;
  for (int threads = 1; threads < last; threads *= 2) counts.push_back(threads);
  counts.push_back(last);
  return counts;
}

/// The same march on 1, 2, 4, ... threads; only the last one is watched, so that all are timed
/// alike.
void time_kernels(Experiment& experiment, int dimension) {
  const std::string name = std::to_string(dimension) + "d";
  const Size size = size_of_march(experiment, dimension);
  const AnyMesh start = size.start_cells > 0 ? paper::start_mesh_of(dimension, size.start_cells)
                                             : paper::start_mesh(dimension, size.elements);
  const int most = experiment.executor().threads();
  Watcher watcher(experiment, name, size.steps);
  std::vector<paper::ThreadRow> rows;
  for (const int threads : thread_counts(most)) {
    paper::March march{goal_of(dimension, size.elements), size.steps};
    if (threads == most)
      march.look = [&](int step, double phase, const AnyMesh& mesh) {
        watcher.look(step, phase, mesh);
      };
    rows.push_back({threads, paper::march(runtime::Executor({.threads = threads}), start, march)});
  }
  say_kernels(experiment, name, rows);
  experiment.claim(rows.front().report.mean_elements == rows.back().report.mean_elements,
                   name + ": as many elements on every number of threads");
  if (dimension == 2)
    draw_plane(experiment, watcher.frames());
  else
    draw_solid(experiment, watcher.frames().back());
}

/// Sizes of meshes, each twice the one before. Below about 10,000 tetrahedra the rate is not yet
/// there to be seen, so the test has one size in 3D.
std::vector<double> element_goals(const Experiment& experiment, int dimension) {
  const double elements = usual_size(experiment, dimension).elements;
  if (dimension == 3)
    return experiment.small() ? std::vector{elements}
                              : std::vector{elements / 4, elements / 2, elements, 2 * elements};
  std::vector<double> goals{elements / 2, elements, 2 * elements};
  if (!experiment.small())
    goals = {elements / 16, elements / 8, elements / 4, elements / 2, elements};
  return goals;
}

/// Meshes adapted to the first solution again and again until they fit it, coarse to fine.
void measure_errors(Experiment& experiment, int dimension) {
  const std::string name = std::to_string(dimension) + "d";
  std::vector<paper::ErrorRow> rows;
  for (const double elements : element_goals(experiment, dimension)) {
    AnyMesh mesh = paper::start_mesh(dimension, elements);
    for (int again = 0; again < (dimension == 2 ? 8 : 5); ++again)
      mesh =
          paper::follow(experiment.executor(), mesh, goal_of(dimension, elements), 0).adapted.mesh;
    const auto count = static_cast<double>(paper::element_count(mesh));
    rows.push_back({count, dimension == 2
                               ? paper::interpolation_error<2>(experiment.executor(), mesh, 0)
                               : paper::interpolation_error<3>(experiment.executor(), mesh, 0)});
  }
  say_errors(experiment, name, rows);
  if (rows.size() > 1)
    experiment.claim(
        paper::convergence_rate(rows) > 0.9 * 2 / dimension,
        name + ": beside the jump the error falls at the optimal rate, elements^(-2/d), or faster");
}

void run(Experiment& experiment) {
  const int only = experiment.arguments().integer("--dimension", 2, 3).value_or(0);
  const std::string part = experiment.arguments().text("--part").value_or("");
  if (!part.empty() && part != "errors" && part != "kernels")
    throw cli::UsageError("expected --part errors or --part kernels, found '" + part + "'");
  for (const int dimension : {2, 3})
    if (only == 0 || only == dimension) {
      if (part != "kernels") measure_errors(experiment, dimension);
      if (part != "errors") time_kernels(experiment, dimension);
    }
}

}  // namespace

int main(int word_count, char** word) {
  return paper::run_experiment(word_count, word,
                               {"Synthetic benchmark: a mesh that follows a front", run, options});
}
