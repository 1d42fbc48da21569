#include "samples.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

namespace ductile::bench::report {
namespace {

using Json = nlohmann::json;

/// Nanoseconds of Google Benchmark's units.
double ns_of(const std::string& unit) {
  static const std::map<std::string, double> ns = {{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  const auto found = ns.find(unit);
  if (found == ns.end()) throw std::runtime_error("expected a unit of time, found " + unit);
  return found->second;
}

/// Members of a benchmark that are not counters.
bool is_known(const std::string& key) {
  static const std::set<std::string> known = {"name",
                                              "family_index",
                                              "per_family_instance_index",
                                              "run_name",
                                              "run_type",
                                              "repetitions",
                                              "repetition_index",
                                              "threads",
                                              "iterations",
                                              "real_time",
                                              "cpu_time",
                                              "time_unit",
                                              "items_per_second",
                                              "bytes_per_second",
                                              "label"};
  return known.count(key) > 0;
}

void add_counters(const Json& benchmark, Sample& sample) {
  for (const auto& [key, value] : benchmark.items()) {
    if (is_known(key) || !value.is_number()) continue;
    if (key == "ping_before_ns") {
      sample.ping_before_ns = value;
    } else if (key == "ping_after_ns") {
      sample.ping_after_ns = value;
    } else {
      sample.counters[key] = value;
    }
  }
}

void add_benchmark(const Json& benchmark, Samples& to) {
  const std::string full_name = benchmark.at("name");
  if (benchmark.value("run_type", "iteration") != "iteration") return;
  const auto name = parse_name(benchmark.value("run_name", full_name));
  if (!name) {
    to.failures.push_back({full_name, "its name is not SUBJECT/CASE/CANDIDATE/threads:N"});
  } else if (benchmark.value("error_occurred", false)) {
    to.failures.push_back({full_name, benchmark.value("error_message", "failed")});
  } else {
    Sample sample;
    sample.name = *name;
    sample.ns = benchmark.at("real_time").get<double>() * ns_of(benchmark.at("time_unit"));
    if (!std::isfinite(sample.ns) || sample.ns <= 0) {
      to.failures.push_back({full_name, "its time is not above zero"});
      return;
    }
    add_counters(benchmark, sample);
    to.samples.push_back(std::move(sample));
  }
}

std::string cache_words(const Json& caches) {
  std::ostringstream words;
  for (const Json& cache : caches)
    words << (words.tellp() > 0 ? ", " : "") << 'L' << cache.value("level", 0) << ' '
          << cache.value("type", "") << ' ' << cache.value("size", 0L) / 1024 << " KiB";
  return words.str();
}

void add_machine(const Json& context, std::map<std::string, std::string>& to) {
  static const std::set<std::string> left_out = {"host_name", "executable", "load_avg"};
  for (const auto& [key, value] : context.items())
    if (key == "caches") {
      to.emplace(key, cache_words(value));
    } else if (left_out.count(key) == 0 && value.is_primitive() && value != "") {
      to.emplace(key, value.is_string() ? value.get<std::string>() : value.dump());
    }
}

Samples read_file(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("it cannot be read");
  const Json whole = Json::parse(in);
  Samples samples;
  for (const Json& benchmark : whole.at("benchmarks")) add_benchmark(benchmark, samples);
  add_machine(whole.at("context"), samples.machine);
  return samples;
}

/// Why a file is left out.
std::string reason(const std::exception& error) {
  if (dynamic_cast<const Json::exception*>(&error) != nullptr)
    return std::string("expected Google Benchmark's JSON, but it is wrong or breaks off: ") +
           error.what();
  return error.what();
}

void append(Samples& to, Samples more) {
  std::move(more.samples.begin(), more.samples.end(), std::back_inserter(to.samples));
  std::move(more.failures.begin(), more.failures.end(), std::back_inserter(to.failures));
  to.machine.merge(more.machine);
}

}  // namespace

std::optional<Name> parse_name(const std::string& name) {
  std::vector<std::string> words;
  std::istringstream in(name);
  for (std::string word; std::getline(in, word, '/');) words.push_back(word);
  const std::string prefix = "threads:";
  if (words.size() < 4 || words[3].compare(0, prefix.size(), prefix) != 0) return {};
  Name parsed{words[0], words[1], words[2]};
  const char* const begin = words[3].data() + prefix.size();
  const char* const end = words[3].data() + words[3].size();
  const auto [stopped, error] = std::from_chars(begin, end, parsed.threads);
  if (error != std::errc() || stopped != end || parsed.threads < 1) return {};
  return parsed;
}

std::string library_of(const std::string& candidate) {
  return candidate.substr(0, candidate.find('.'));
}

Samples read_samples(const std::vector<std::filesystem::path>& files) {
  Samples samples;
  for (const std::filesystem::path& file : files) try {
      append(samples, read_file(file));
    } catch (const std::exception& error) {
      samples.unread.push_back({file.string(), reason(error)});
    }
  if (!files.empty() && samples.unread.size() == files.size())
    throw std::runtime_error("no file can be read; " + samples.unread.front().name + ": " +
                             samples.unread.front().message);
  return samples;
}

}  // namespace ductile::bench::report
