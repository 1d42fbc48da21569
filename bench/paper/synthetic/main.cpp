/// @file
/// The synthetic benchmark: a mesh follows a moving front in the unit square and cube. Measures the
/// time of each kernel on 1, 2, 4, ... threads, and how the interpolation error falls with the
/// number of elements.

#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "cases/psi.hpp"
#include "ductile/meshadapt/files.hpp"
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
    {"--elements", "N", "of the meshes (default: the paper's 550000; 3D: 210000)"},
    {"--steps", "N", "of time, into which the period is divided (default: 50)"},
    {"--timed", "N", "of these, steps to time on 1, 2, 4, ... threads (default: 10)"},
    {"--until", "N", "stops after this step, and leaves out errors and pictures"},
}};

struct Size {
  double elements = 0;
  int steps = 0;
  int start_cells = 0;  ///< along each axis of the start mesh; 0: chosen for as many elements
};

Size size_of_march(const Experiment& experiment, int dimension) {
  const cli::Arguments& given = experiment.arguments();
  // The sizes of the paper, and those of the test.
  Size size = dimension == 2 ? Size{550000, 50, 200} : Size{210000, 50, 50};
  if (experiment.small()) size = dimension == 2 ? Size{2000, 4} : Size{3000, 4};
  if (const auto elements = given.positive("--elements"))
    size.elements = *elements, size.start_cells = 0;
  size.steps = given.integer("--steps", 1, 10000).value_or(size.steps);
  return size;
}

paper::MeshGoal goal_of(int dimension, double elements) {
  paper::MeshGoal goal{.elements = elements};
  if (dimension == 3) {
    goal.smallest = 1e-4;
    goal.anisotropy = 100;
  }
  return goal;
}

// ---- Pictures of a march ----

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

void write_scene(const Experiment& experiment, const std::string& name, const cli::Scene& scene,
                 int size) {
  meshadapt::AtomicOutputs outputs;
  write_bytes(outputs, experiment.file(name), cli::draw(scene, cli::PictureFormat::png, size));
  outputs.commit();
}

/// [tetrahedron] Colour for the mean of psi at its corners.
std::vector<cli::Colour> psi_colours(const Frame& frame) {
  std::vector<cli::Colour> colour_of;
  colour_of.reserve(frame.mesh.tetrahedra.size());
  for (const auto& corners : frame.mesh.tetrahedra.vertices) {
    double sum = 0;
    for (const std::uint32_t v : corners) sum += frame.value_of[v];
    colour_of.push_back(cli::size_colour(0.5 + sum / 4 / 3.2));
  }
  return colour_of;
}

/// Draws cuts through the cube at several times, coloured by psi, and the last one also by size.
void draw_solid(Experiment& experiment, const std::vector<Frame>& frames) {
  const int axis = 2;
  cli::Scene strip;
  strip.caption = "psi from -1.6 (dark) to 1.6, in the lower half of the unit cube";
  for (const Frame& frame : frames) {
    strip.panels.push_back(
        cli::cut_panel(frame.mesh, psi_colours(frame), cli::camera_along(axis), axis));
    strip.panels.back().title = title_of(frame);
  }
  write_scene(experiment, "frames_3d.png", strip, 500);
  write_scene(experiment, "cut_3d.png",
              cli::make_scene(experiment.executor(), frames.back().mesh, nullptr,
                              {.tint = cli::Tint::size, .cut_axis = axis}),
              700);
}

/// Keeps some frames, and writes some to the series.
class Watcher {
 public:
  Watcher(Experiment& experiment, const std::string& name, int steps)
      : executor_(experiment.executor()),
        series_(experiment.file(name + ".pvd")),
        name_(name),
        steps_(steps) {}

  void look(int step, double phase, const AnyMesh& mesh) {
    progress_.show((step + 1.0) / steps_,
                   name_ + ": " + std::to_string(paper::element_count(mesh)) + " elements");
    std::vector<double> value_of = paper::sampled_solution(executor_, mesh, phase).values;
    if (step % std::max(1, steps_ / 10) == 0)
      series_.add(phase, mesh, {{"psi", meshadapt::AnyField::Type::scalar, value_of}});
    if ((step + 1) * 3 / steps_ > step * 3 / steps_) {
      frames_.push_back({step, phase, mesh, std::move(value_of)});
      frames_.back().mesh.name = name_ + ", step " + std::to_string(step + 1);
    }
  }
  const std::vector<Frame>& frames() const { return frames_; }

 private:
  const runtime::Executor& executor_;
  paper::ProgressLine progress_;
  paper::VtuSeries series_;
  std::string name_;
  int steps_;
  std::vector<Frame> frames_;
};

// ---- The two halves of the benchmark ----

/// Powers of 2 below the last count.
std::vector<int> thread_counts_below(int last) {
  std::vector<int> counts;
  for (int threads = 1; threads < last; threads *= 2) counts.push_back(threads);
  return counts;
}

/// Runs one march on all threads, and some of its steps on fewer threads as well.
void time_kernels(Experiment& experiment, int dimension) {
  const std::string name = std::to_string(dimension) + "d";
  const cli::Arguments& given = experiment.arguments();
  const Size size = size_of_march(experiment, dimension);
  const int until = given.integer("--until", 1, size.steps).value_or(size.steps);
  Watcher watcher(experiment, name, until);
  const paper::MarchReport report =
      paper::march(experiment.executor(),
                   size.start_cells > 0 ? paper::start_mesh_of(dimension, size.start_cells)
                                        : paper::start_mesh(dimension, size.elements),
                   {.goal = goal_of(dimension, size.elements),
                    .steps = size.steps,
                    .until = until,
                    .timed = given.integer("--timed", 1, until).value_or(std::min(until, 10)),
                    .threads = thread_counts_below(experiment.executor().threads()),
                    .look = [&](int step, double phase, const AnyMesh& mesh) {
                      watcher.look(step, phase, mesh);
                    }});
  say_kernels(experiment, name, report);
  experiment.claim(
      report.identical,
      name + ": meshes and metrics are the same, byte for byte, on each number of threads");
  if (until < size.steps) return;
  if (dimension == 2)
    draw_plane(experiment, watcher.frames());
  else
    draw_solid(experiment, watcher.frames());
}

/// Sizes of meshes, each twice the previous one, up to that of the march. The rate does not show
/// below about 10,000 tetrahedra, so the test has one size in 3D.
std::vector<double> element_goals(const Experiment& experiment, int dimension) {
  const double elements = size_of_march(experiment, dimension).elements;
  if (experiment.small())
    return dimension == 3 ? std::vector{elements}
                          : std::vector{elements / 2, elements, 2 * elements};
  std::vector<double> goals{elements / 8, elements / 4, elements / 2, elements};
  if (dimension == 2) goals.insert(goals.begin(), elements / 16);
  return goals;
}

/// Meshes adapted to the first solution again and again until they fit it, coarse to fine.
void measure_errors(Experiment& experiment, int dimension) {
  const std::string name = std::to_string(dimension) + "d";
  const std::vector<double> goals = element_goals(experiment, dimension);
  paper::ProgressLine progress;
  std::vector<paper::ErrorRow> rows;
  double done = 0;
  for (const double elements : goals) {
    progress.show(done, name + ", errors");
    done += elements / std::accumulate(goals.begin(), goals.end(), 0.0);
    paper::MeshGoal goal = goal_of(dimension, elements);
    const AnyMesh mesh =
        paper::fitted_mesh(experiment.executor(), paper::start_mesh(dimension, elements), goal,
                           std::vector<double>(dimension == 2 ? 8 : 5, 0.0));
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
  for (const int dimension : {2, 3})
    if (only == 0 || only == dimension) {
      if (!experiment.arguments().has("--until")) measure_errors(experiment, dimension);
      time_kernels(experiment, dimension);
    }
}

}  // namespace

int main(int word_count, char** word) {
  return paper::run_experiment(
      word_count, word,
      {"Synthetic benchmark: a mesh that follows a front", run, DUCTILE_PLOTS, options});
}
