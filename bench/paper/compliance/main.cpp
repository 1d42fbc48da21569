/// @file
/// Structural compliance minimisation: the stiffest cantilever of a given volume, on meshes that
/// follow the design, beside the same on a fine uniform mesh. Both structures are judged on one
/// mesh that is finer still.

#include <algorithm>
#include <array>
#include <cmath>

#include "cantilever.hpp"
#include "study.hpp"

namespace {

using namespace ductile;
using paper::Experiment;
using paper::Outcome;
using paper::Settings;

constexpr std::array<cli::Option, 5> options{{
    {"--dimension", "2|3", "of the cantilever (default: 2)"},
    {"--length", "X", "minimum length of bars and holes (default: 0.01; 3D: 0.08)"},
    {"--elements", "N", "of adapted meshes, before gradation (default: 8000)"},
    {"--cells", "N", "of the uniform mesh across the height, a multiple of 10"},
    {"--iterations", "N", "of the optimisation (default: 120; 3D: 40)"},
}};

/// The two optimisations, and the cells across the height of the mesh that judges both.
struct Study {
  Settings adapted, uniform;
  int judge_cells = 0;
};

/// Defaults: in the plane, in space, and of the test in the plane.
struct Defaults {
  double length = 0, elements = 0;
  int iterations = 0, start_cells = 0, uniform_cells = 0, judge_cells = 0;
};
constexpr Defaults plane{0.01, 8000, 120, 50, 200, 400};
constexpr Defaults space{0.08, 8000, 40, 10, 20, 30};
constexpr Defaults test{0.05, 1000, 30, 10, 40, 80};

/// The contrast and the number of elements that conjugate gradients and a cube's third dimension
/// leave room for.
void fit_to_space(Settings& settings) {
  settings.problem.void_stiffness = 1e-4;
  settings.adaptation.smallest = 0.2;
  settings.adaptation.anisotropy = 5;
  settings.adaptation.gradation = 2;
}

Study study_of(const Experiment& experiment, int dimension) {
  const Defaults& usual = dimension == 3 ? space : experiment.small() ? test : plane;
  const cli::Arguments& given = experiment.arguments();
  Study study;
  Settings& settings = study.adapted;
  settings.problem.minimum_length = given.positive("--length").value_or(usual.length);
  settings.path.iterations = given.integer("--iterations", 10, 10000).value_or(usual.iterations);
  settings.adaptation.elements = given.positive("--elements").value_or(usual.elements);
  settings.cells = usual.start_cells;
  if (dimension == 3) fit_to_space(settings);
  study.uniform = settings;
  study.uniform.adaptation.elements = 0;
  study.uniform.cells = given.integer("--cells", 10, 1000).value_or(usual.uniform_cells);
  study.judge_cells = std::max(usual.judge_cells, study.uniform.cells);
  return study;
}

template <int Dim>
paper::Judgement judge(const Experiment& experiment, const Outcome& outcome, const Study& study) {
  return paper::judge<Dim>(experiment.executor(), {outcome.mesh, outcome.density_of},
                           paper::cantilever_mesh<Dim>(study.judge_cells), study.adapted.problem);
}

void say_outcome(Experiment& experiment, const Outcome& outcome,
                 const paper::Judgement& judgement) {
  experiment.say("%-12s %9zu %11.3f %11.3f %8.4f %8.1f %8.1f %8.1f", outcome.name.c_str(),
                 outcome.last.elements, outcome.last.compliance, judgement.compliance,
                 judgement.volume_fraction, outcome.seconds, outcome.solve_seconds,
                 outcome.adapt_seconds);
}

template <int Dim>
void compare(Experiment& experiment) {
  const Study study = study_of(experiment, Dim);
  const std::string end = Dim == 2 ? "2d" : "3d";
  const std::vector<Outcome> outcomes{
      paper::optimise<Dim>(experiment, "adapted_" + end, study.adapted),
      paper::optimise<Dim>(experiment, "uniform_" + end, study.uniform)};
  paper::draw_outcomes<Dim>(experiment, "structures_" + end + ".png", outcomes);
  const paper::Judgement adapted = judge<Dim>(experiment, outcomes[0], study);
  const paper::Judgement uniform = judge<Dim>(experiment, outcomes[1], study);
  experiment.say("\n%-12s %9s %11s %11s %8s %8s %8s %8s", "mesh", "elements", "compliance",
                 "judged", "volume", "seconds", "solve", "adapt");
  say_outcome(experiment, outcomes[0], adapted);
  say_outcome(experiment, outcomes[1], uniform);
  const double volume = study.adapted.problem.volume_fraction;
  experiment.claim(std::abs(adapted.volume_fraction - volume) < 0.002 * volume,
                   "the volume is the one that was asked for");
  experiment.claim(adapted.compliance < 1.03 * uniform.compliance,
                   "the adapted run is as stiff as the uniform one, or within 3 % of it");
  if (!experiment.small())
    experiment.claim(2 * outcomes[0].last.elements < outcomes[1].last.elements,
                     "it needs less than half the elements");
}

void run(Experiment& experiment) {
  if (experiment.arguments().integer("--dimension", 2, 3).value_or(2) == 2)
    compare<2>(experiment);
  else
    compare<3>(experiment);
}

}  // namespace

int main(int word_count, char** word) {
  return paper::run_experiment(
      word_count, word,
      {"Compliance minimisation: the stiffest cantilever of a given volume", run, options});
}
