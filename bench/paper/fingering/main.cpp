/// @file
/// Viscous fingering: a fluid displaces one that is e^2 times as viscous from a porous medium, and
/// the front between them breaks up into fingers. First adapted and uniform meshes are compared at
/// an early time with a much finer run; then one adapted run goes on until the fingers arrive.

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fingering/study.hpp"
#include "shared/experiment.hpp"
#include "shared/picture.hpp"
#include "shared/progress_line.hpp"
#include "shared/table.hpp"
#include "shared/vtu_series.hpp"

namespace {

using namespace ductile;
using namespace ductile::paper;

/// The default settings, and those of the test.
struct Plan {
  int reference_cells;  ///< from bottom to top in the reference's uniform mesh
  std::vector<int> uniform_cells;
  std::vector<double> adapted_errors;  ///< see AdaptGoal
  double show_error;
  double compare_at, show_until;  ///< times
};

constexpr int adapt_every = 16;  // intervals; in which fingers advance by the front's thickness

Plan plan_for(const Experiment& experiment) {
  if (experiment.small()) return {48, {16, 32}, {0.012, 0.006}, 0.004, 0.1, 0.3};
  return {512, {32, 64, 128, 192, 256}, {0.004, 0.002, 0.001, 0.0005}, 0.0015, 0.2, 1.2};
}

AdaptGoal goal_of(double error) { return {.saturation_error = error, .pressure_error = error}; }

std::string text(const char* format, double number) {
  std::array<char, 100> result{};
  std::snprintf(result.data(), result.size(), format, number);
  return result.data();
}

/// Claims about conservation, checked for every run.
void claim_conservation(Experiment& experiment, const Simulation& run) {
  experiment.say("mass balance %.1e, largest change in a transfer %.1e, overshoot %.1e",
                 run.mass_error(), run.transfer_error(), run.overshoot());
  experiment.claim(std::abs(run.mass_error()) < 1e-11, "mass is conserved, transfers included");
  experiment.claim(run.overshoot() < 1e-9, "the saturation stays between 0 and 1");
}

// ---- Adapted against uniform ----

class Comparison {
 public:
  Comparison(Experiment& experiment, const Plan& plan) : experiment_(experiment), plan_(plan) {}

  void run() {
    reference_ = run_to_end({.cells = plan_.reference_cells}, "the reference");
    experiment_.say("reference: %.0f triangles", reference_->mean_triangles());
    claim_conservation(experiment_, *reference_);
    for (const int cells : plan_.uniform_cells)
      add(*run_to_end({.cells = cells}, std::to_string(cells) + " cells across"));
    for (const double error : plan_.adapted_errors)
      add(*run_to_end({.adapt_every = adapt_every, .goal = goal_of(error)},
                      text("adapted to %g", error)));
    report();
  }

 private:
  std::unique_ptr<Simulation> run_to_end(RunOptions options, const std::string& name) {
    options.end = plan_.compare_at;
    return run_case(experiment_.executor(), options, [&](const Simulation& run) {
      progress_.show(run.time() / options.end,
                     name + ", " + std::to_string(run.mesh().triangles.size()) + " triangles");
    });
  }

  void add(const Simulation& run) {
    outcomes_.push_back(compare(experiment_.executor(), run, *reference_));
    experiment_.say("%s, %.0f triangles: error %.2e, %.1f s, of processors %.1f s",
                    run.adapted() ? "adapted" : "uniform", outcomes_.back().triangles,
                    outcomes_.back().error, outcomes_.back().seconds.wall,
                    outcomes_.back().seconds.processor);
    claim_conservation(experiment_, run);
  }

  void report() const {
    Table table({"adapted", "triangles", "error", "seconds", "processor_seconds", "solver_seconds",
                 "steps"});
    std::vector<Outcome> uniform;
    for (const Outcome& run : outcomes_) {
      table.add({run.adapted ? 1.0 : 0.0, run.triangles, run.error, run.seconds.wall,
                 run.seconds.processor, run.solving.processor, static_cast<double>(run.steps)});
      if (!run.adapted) uniform.push_back(run);
    }
    table.write_csv(experiment_.file("comparison.csv"));
    for (const Outcome& run : outcomes_) {
      if (!run.adapted) continue;
      const Outcome same = uniform_for_error(uniform, run.error);
      experiment_.say(
          "error %.2e: adapted %.0f triangles, %.2f s, %.2f of them to solve; uniform needs "
          "%.1f, %.2f and %.2f times as many",
          run.error, run.triangles, run.seconds.processor, run.solving.processor,
          same.triangles / run.triangles, same.seconds.processor / run.seconds.processor,
          same.solving.processor / run.solving.processor);
      experiment_.claim(same.triangles > run.triangles, "adapted meshes need fewer triangles");
      if (!experiment_.small())
        experiment_.claim(same.seconds.processor > run.seconds.processor,
                          "and less time, adapting and transferring included");
    }
  }

  Experiment& experiment_;
  const Plan& plan_;
  ProgressLine progress_;
  std::unique_ptr<Simulation> reference_;
  std::vector<Outcome> outcomes_;
};

// ---- The fingers ----

ColourBar saturation_bar() { return {"saturation phi, domain 2 x 1", 0, 1}; }

/// Contents of a frame of the strip, kept until all are there.
struct Frame {
  meshadapt::AnyMesh mesh;
  std::vector<double> saturation_of;
  std::string title;
};

void draw_strip(const std::filesystem::path& path, const std::vector<Frame>& frames) {
  std::vector<FieldPanel> panels;
  panels.reserve(frames.size());
  for (const Frame& frame : frames)
    panels.push_back({.mesh = frame.mesh, .value_of = frame.saturation_of, .title = frame.title});
  write_png(path, panels, {.columns = 3, .panel_width = 330, .bar = saturation_bar()});
}

class Show {
 public:
  explicit Show(Experiment& experiment)
      : experiment_(experiment), series_(experiment.file("fingers.pvd")) {}

  void run(const Plan& plan) {
    const RunOptions options{
        .end = plan.show_until, .adapt_every = adapt_every, .goal = goal_of(plan.show_error)};
    const auto end = run_case(experiment_.executor(), options, [&](Simulation& run) {
      progress_.show(run.time() / options.end,
                     std::to_string(run.mesh().triangles.size()) + " triangles");
      if (intervals_++ % 8 == 0) record(run);
      const double strip_at = options.end * static_cast<double>(strip_.size() + 1) / strip_frames;
      if (run.time() > strip_at - options.interval / 2)
        strip_.push_back({run.mesh(), run.saturation(), "time " + text("%.2f", run.time())});
    });
    draw_strip(experiment_.file("strip.png"), strip_);
    history_.write_csv(experiment_.file("history.csv"));
    const Timings& timings = end->timings();
    experiment_.say(
        "fingers: %.0f triangles, %d steps; seconds: pressure %.1f, transport %.1f, adaptation "
        "%.1f, transfer %.1f; of processors in all %.1f",
        end->mean_triangles(), end->steps(), timings.pressure.wall, timings.transport.wall,
        timings.adaptation.wall, timings.transfer.wall, timings.total().processor);
    claim_conservation(experiment_, *end);
    experiment_.claim(reach(0) < reach(history_.size() - 1), "fingers grow");
  }

 private:
  double reach(std::size_t row) const { return history_.row(row)[3] - history_.row(row)[2]; }

  void record(Simulation& run) {
    const Fingers now = fingers(run);
    history_.add({run.time(), static_cast<double>(run.mesh().triangles.size()), now.root, now.tip,
                  static_cast<double>(now.count), run.mass_error(), run.overshoot()});
    const std::string number = std::to_string(1000 + history_.size() - 1).substr(1);
    const FieldPanel saturation{.mesh = run.mesh(),
                                .value_of = run.saturation(),
                                .title = "time " + text("%.2f", run.time())};
    write_png(experiment_.file("animation/" + number + ".png"), {saturation}, {.panel_width = 480});
    if (history_.size() % 5 != 1) return;
    const std::string count = std::to_string(run.mesh().triangles.size());
    write_png(experiment_.file("frames/" + number + ".png"),
              {saturation, {.mesh = run.mesh(), .lines = true, .title = count + " triangles"}},
              {.panel_width = 560, .bar = saturation_bar()});
    series_.add(run.time(), run.mesh(),
                {{"saturation", meshadapt::AnyField::Type::scalar, run.saturation()},
                 {"pressure", meshadapt::AnyField::Type::scalar, run.pressure()}});
  }

  Experiment& experiment_;
  ProgressLine progress_;
  VtuSeries series_;
  Table history_{{"time", "triangles", "root", "tip", "fingers", "mass_error", "overshoot"}};
  static constexpr int strip_frames = 6;
  std::vector<Frame> strip_;
  int intervals_ = 0;
};

void run(Experiment& experiment) {
  const Plan plan = plan_for(experiment);
  Comparison(experiment, plan).run();
  Show(experiment).run(plan);
}

}  // namespace

int main(int word_count, char** word) {
  return run_experiment(
      word_count, word,
      {"Viscous fingering in a porous medium, viscosity ratio e^2", run, DUCTILE_PLOTS});
}
