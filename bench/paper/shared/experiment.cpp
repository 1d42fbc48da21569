#include "shared/experiment.hpp"

#include <array>
#include <chrono>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::paper {

namespace {

namespace fs = std::filesystem;

constexpr std::array<cli::Option, 3> common_options{{
    {"-o", "FOLDER", "where everything is written (default: the folder 'out')", "--output"},
    {"--small", "", "runs the test of a few seconds"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
}};

std::vector<cli::Option> all_options(const ExperimentEntry& entry) {
  std::vector<cli::Option> options(common_options.begin(), common_options.end());
  options.insert(options.end(), entry.options.begin(), entry.options.end());
  return options;
}

bool asks_for_help(const std::vector<std::string>& words) {
  return words.size() == 1 && (words[0] == "-h" || words[0] == "--help");
}

void print_help(const ExperimentEntry& entry) {
  std::printf("%s\n\nOptions:\n%s", entry.title, cli::help_lines(all_options(entry)).c_str());
}

Experiment::Setup setup_from(const ExperimentEntry& entry, const std::vector<std::string>& words) {
  const cli::Arguments arguments(all_options(entry), words);
  if (!arguments.operands().empty())
    throw cli::UsageError("expected options only, found '" + arguments.operands()[0] + "'");
  return {.folder = arguments.text("-o").value_or("out"),
          .small = arguments.has("--small"),
          .threads = arguments.integer("--threads", 1, 4096).value_or(0),
          .arguments = arguments};
}

/// The path quoted as one word for a shell.
std::string word(const fs::path& path) {
  std::string text = "'";
  for (const char c : fs::absolute(path).string())
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Runs a gnuplot script in the folder with the tables, where it writes the plots.
void draw_plots(Experiment& experiment, const fs::path& script) {
  const std::string command = "cd " + word(experiment.folder()) + " && gnuplot " + word(script);
  if (std::system(command.c_str()) != 0)
    experiment.say("Some plots are missing, because gnuplot is not on the PATH, or failed.");
}

}  // namespace

Experiment::Experiment(const Setup& setup) : setup_(setup), executor_({.threads = setup.threads}) {
  std::error_code error;
  fs::create_directories(setup_.folder, error);
  if (error) throw meshadapt::Error(setup_.folder.string() + ": " + error.message());
  std::ofstream(file("report.txt"));  // clears the report of an earlier run
}

fs::path Experiment::file(const std::string& name) const {
  fs::path path = setup_.folder / name;
  fs::create_directories(path.parent_path());
  return path;
}

void Experiment::say(const char* format, ...) {
  std::array<char, 1000> line{};
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(line.data(), line.size(), format, values);
  va_end(values);
  std::printf("%s\n", line.data());
  std::fflush(stdout);
  std::ofstream(file("report.txt"), std::ios::app) << line.data() << '\n';
}

void Experiment::claim(bool holds, const std::string& what) {
  say("%s: %s", holds ? "holds" : "FAILS", what.c_str());
  if (!holds) ++failed_claims_;
}

int run_experiment(int word_count, char** word, const ExperimentEntry& entry) {
  const std::vector<std::string> words(word + 1, word + word_count);
  try {
    if (asks_for_help(words)) {
      print_help(entry);
      return 0;
    }
    Experiment experiment(setup_from(entry, words));
    experiment.say("%s; %d threads", entry.title, experiment.executor().threads());
    const auto start = std::chrono::steady_clock::now();
    entry.run(experiment);
    draw_plots(experiment, entry.plots);
    experiment.say("took %.1f s",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return experiment.all_claims_held() ? 0 : 1;
  } catch (const cli::UsageError& error) {
    std::fprintf(stderr, "%s: %s\n", word[0], error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", word[0], error.what());
    return 1;
  }
}

}  // namespace ductile::paper
