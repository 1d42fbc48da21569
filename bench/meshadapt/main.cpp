/// @file
/// Benchmark of whole adaptations: time by kernel and phase on 1, 2, ... threads, the cost of the
/// published method on the same kernels, quality and memory; and Mmg on the same files, if it is
/// installed. Writes every sample to results.json, from which bench/report makes a page.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "copies.hpp"
#include "ductile/runtime/executor.hpp"
#include "peer.hpp"
#include "plan.hpp"
#include "results.hpp"
#include "sample.hpp"
#include "system.hpp"

namespace {

namespace fs = std::filesystem;
using namespace ductile::bench;
using ductile::cli::Arguments;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void say(const Sample& sample) {
  std::printf("%-16s %3d threads %-13s %8.3f s %9zu elements, cores %s%s%s\n",
              sample.case_name.c_str(), sample.settings.threads, name_of(sample.settings.mode),
              sample.wall_seconds, sample.elements, sample.placement().c_str(),
              sample.steady() ? "" : ", which moved meanwhile",
              sample.figures.valid ? "" : ", NOT VALID");
  std::fflush(stdout);
}

/// Runs as many copies as the largest number of threads with a core each. More copies would tell
/// nothing, and each needs its own memory.
void measure_copies(Results& results, const Plan& plan, const AdaptCase& made,
                    const Sampler& sampler) {
  int copies = 1;
  for (const RunSettings& settings : settings_for(plan, made.name))
    if (settings.threads <= ductile::runtime::available_cores())
      copies = std::max(copies, settings.threads);
  if (copies == 1) return;
  const auto work = [&] { return sampler.first_call_alone(); };
  const double speed = speed_of_copies(work, copies);
  results.copies.push_back({made.name, copies, speed});
  std::printf("%-16s %3d copies get %.2f times as much done as one\n", made.name.c_str(), copies,
              speed);
}

/// Runs all settings alternately, repeatedly, so that other load on the machine affects all alike.
void measure_case(Results& results, const Plan& plan, const AdaptCase& made) {
  Sampler sampler(made);
  // The first use of memory is slow on a virtual machine, whose host must provide it. Medians of
  // several runs hide that; a single run of a large case needs a call in advance.
  if (is_large(made.name)) sampler.first_call_alone();
  const auto start = std::chrono::steady_clock::now();
  const int repetitions = is_large(made.name) ? 1 : plan.repetitions;
  for (int i = 0; i < repetitions && (i == 0 || seconds_since(start) < plan.seconds); ++i)
    for (const RunSettings& settings : settings_for(plan, made.name)) {
      results.samples.push_back(sampler.take(settings, i));
      say(results.samples.back());
    }
  if (!is_large(made.name)) measure_copies(results, plan, made, sampler);
}

void measure_peer(Results& results, const Plan& plan, const AdaptCase& made) {
  if (!plan.peers || !made.has_peers || is_large(made.name)) return;
  const auto mmg = find_mmg(made.dimension);
  if (!mmg) {
    results.notes.push_back(made.name + " was not run with Mmg, which is not on the PATH.");
    return;
  }
  for (const Pair& pair :
       run_pairs(made, *mmg, {plan.folder / "pairs", plan.pairs, plan.seconds / 2})) {
    std::printf("%-16s as programs: Ductile %.2f s, Mmg %.2f s (status %d)\n", made.name.c_str(),
                pair.ductile.child.processor_seconds, pair.mmg.child.processor_seconds,
                pair.mmg.child.status);
    results.pairs.push_back(pair);
    if (pair.ductile.child.status != 0 || pair.mmg.child.status != 0)
      results.notes.push_back(made.name + ": a program failed, see results.json.");
  }
}

/// Writes results after each case, so that an interrupted run keeps them.
int run(const Plan& plan) {
  const auto start = std::chrono::steady_clock::now();
  Results results;
  fs::create_directories(plan.folder);
  const fs::path file = plan.folder / "results.json";
  fs::remove(file);  // left by an earlier run
  for (const std::string& name : plan.cases) {
    const AdaptCase made = make_case(ductile::runtime::Executor(), name);
    measure_case(results, plan, made);
    measure_peer(results, plan, made);
    write_json(results, file);
  }
  results.notes.push_back("Measured in " + std::to_string(static_cast<int>(seconds_since(start))) +
                          " s.");
  write_json(results, file);
  std::printf("\nAll samples are in %s\n", fs::absolute(file).c_str());
  if (!results.sound())
    std::fprintf(stderr, "adapt_bench: a mesh is not valid, or threads made a difference\n");
  return results.sound() ? 0 : 1;
}

void print_help() {
  std::printf("Measures mesh adaptation.\n\nOptions:\n%s",
              ductile::cli::help_lines(plan_options()).c_str());
  std::printf("\nCases:\n");
  for (const CaseInfo& info : known_cases())
    std::printf("  %-16s %s\n", std::string(info.name).c_str(), std::string(info.what).c_str());
}

}  // namespace

int main(int word_count, char** word) {
  try {
    const std::vector<std::string> words(word + 1, word + word_count);
    const Arguments arguments(plan_options(), words);
    if (arguments.has("--help")) {
      print_help();
      return 0;
    }
    const Plan plan = plan_from(arguments);
    ductile::cli::reuse_memory(plan.most_threads);  // as the program ductile does
    return run(plan);
  } catch (const ductile::cli::UsageError& error) {
    std::fprintf(stderr, "adapt_bench: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adapt_bench: %s\n", error.what());
    return 1;
  }
}
