/// @file
/// Irregular algorithms: lean serial code and Ductile on the same inputs, in the same run and
/// alternating, each result checked. Prints a table of medians, and writes them as JSON.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "options.hpp"
#include "peers.hpp"
#include "report.hpp"
#include "suite.hpp"

namespace {

using namespace ductile::bench::irregular;
using ductile::runtime::Executor;
using ductile::runtime::Placement;

constexpr double enough_seconds = 20;  // per input; after that no more repetitions

double median(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t half = samples.size() / 2;
  return samples.size() % 2 == 1 ? samples[half] : (samples[half - 1] + samples[half]) / 2;
}

/// Runs the serial code and then Ductile on each number of threads, repeatedly, so that other load
/// on the machine affects all alike.
std::vector<Measurement> measure(Problem& problem, const Options& options) {
  std::vector<Executor> executors;
  if (problem.has_ductile())
    for (const int threads : options.threads)
      executors.emplace_back(Executor({.threads = threads, .placement = Placement::compact}));
  std::vector<std::vector<double>> samples(1 + executors.size());
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < options.repetitions; ++i) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    if (i > 0 && passed.count() > enough_seconds) break;
    samples[0].push_back(problem.run_serially());
    for (std::size_t k = 0; k < executors.size(); ++k)
      samples[1 + k].push_back(problem.run_ductile(executors[k]));
  }
  const double serial = median(samples[0]);
  std::vector<Measurement> measurements{{{}, {}, "serial", 1, serial, serial}};
  for (std::size_t k = 0; k < executors.size(); ++k)
    measurements.push_back(
        {{}, {}, "Ductile", executors[k].threads(), median(samples[1 + k]), serial});
  return measurements;
}

/// Measures an input: one result per program and number of threads.
std::vector<Measurement> measure(const Algorithm& algorithm, const std::string& input,
                                 std::size_t size, const Options& options) {
  const auto problem = algorithm.problem(input, size);
  std::vector<Measurement> measurements = measure(*problem, options);
  const double serial = measurements.front().seconds;
  for (Measurement& peer :
       measure_peers(algorithm.name, *problem, options.threads, options.repetitions)) {
    peer.serial_seconds = serial;
    measurements.push_back(peer);
  }
  for (Measurement& measurement : measurements) {
    measurement.algorithm = algorithm.name;
    measurement.input = input + '-' + std::to_string(size);
    print(measurement);
  }
  return measurements;
}

/// The algorithms named by the options.
std::vector<Algorithm> chosen(const Options& options) {
  std::vector<Algorithm> all = algorithms();
  std::string known;
  for (const Algorithm& algorithm : all) known += ' ' + algorithm.name;
  for (const std::string& name : options.only)
    if (std::none_of(all.begin(), all.end(), [&](const auto& each) { return each.name == name; }))
      throw UsageError("--only: there is no algorithm '" + name + "'; there are" + known);
  std::erase_if(all, [&](const Algorithm& algorithm) {
    return !options.only.empty() && std::find(options.only.begin(), options.only.end(),
                                              algorithm.name) == options.only.end();
  });
  return all;
}

/// Runs the suite. Returns true if all results were valid.
bool run(const Options& options) {
  const std::vector<Algorithm> rows = chosen(options);
  JsonFile json(options.json);
  std::vector<Measurement> measurements;
  bool right = true;
  print_head();
  for (const Algorithm& algorithm : rows)
    for (const std::string& input : algorithm.inputs)
      for (const std::size_t size : options.sizes) try {
          const auto more = measure(algorithm, input, size, options);
          measurements.insert(measurements.end(), more.begin(), more.end());
        } catch (const std::runtime_error& error) {
          right = false;
          std::fprintf(stderr, "irregular_bench: %s, %s-%zu: %s\n", algorithm.name.c_str(),
                       input.c_str(), size, error.what());
        }
  json.write(measurements);
  return right;
}

}  // namespace

int main(int word_count, char** word) {
  try {
    const Options options = options_from({word + 1, word + word_count});
    if (options.help) {
      std::printf(
          "Measures serial codes and Ductile on irregular algorithms, alternating, and checks what "
          "they\ngive. Programs of PBBS and Galois that are on the PATH run beside "
          "them.\n\nOptions:\n%s",
          ductile::cli::help_lines(known_options()).c_str());
      return 0;
    }
    return run(options) ? 0 : 1;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "irregular_bench: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "irregular_bench: %s\n", error.what());
    return 1;
  }
}
