/// @file
/// The main() of an experiment: its command line, the folder for all outputs, and the claims that
/// it checks. An experiment is one function:
///   void run(Experiment& experiment);
///   int main(int count, char** word) { return run_experiment(count, word, {"title", run}); }
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "arguments.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::paper {

class Experiment {
 public:
  struct Setup {
    std::filesystem::path folder;
    bool small = false;
    int threads = 0;
    cli::Arguments arguments{{}, {}};
  };

  /// Makes the folder. Throws Error if that cannot be done.
  explicit Experiment(const Setup& setup);

  const runtime::Executor& executor() const { return executor_; }

  /// True for a test, which should take seconds, not minutes.
  bool small() const { return setup_.small; }

  /// The parsed command line, for options of the experiment itself (ExperimentEntry::options).
  const cli::Arguments& arguments() const { return setup_.arguments; }

  const std::filesystem::path& folder() const { return setup_.folder; }

  /// The path of an output file; makes folders in its name.
  std::filesystem::path file(const std::string& name) const;

  /// Prints a line, and keeps it for the file report.txt. `format` is as in printf.
  [[gnu::format(printf, 2, 3)]] void say(const char* format, ...);

  /// Prints the claim and whether it holds. If a claim does not hold, the program fails at the end.
  void claim(bool holds, const std::string& what);

  bool all_claims_held() const { return failed_claims_ == 0; }

 private:
  Setup setup_;
  runtime::Executor executor_;
  int failed_claims_ = 0;
};

struct ExperimentEntry {
  const char* title;  ///< one line for help
  void (*run)(Experiment&);
  const char* plots;  ///< the gnuplot script that draws its figures from its tables
  std::span<const cli::Option> options = {};  ///< in addition to those of all experiments
};

/// Returns the exit status: 0 if the experiment ran to its end and all its claims held.
int run_experiment(int word_count, char** word, const ExperimentEntry& entry);

}  // namespace ductile::paper
