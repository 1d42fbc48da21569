#include "plan.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "cases/adapt_case.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::bench {

namespace {

constexpr std::array<cli::Option, 9> options{{
    {"--cases", "A,B", "only these; NAME@FACTOR is NAME at so many times its size"},
    {"--quick", "", "small sizes, in less than two minutes"},
    {"--threads", "N", "at most this many (default: the cores this process may use)"},
    {"--repetitions", "N", "of each measurement, of which the median counts (default: 5)"},
    {"--seconds", "S", "begin no further repetition of a case after so long (default: 120)"},
    {"--scale", "F", "multiplies the size of each case"},
    {"-o", "FOLDER", "where everything goes (default: bench-results/meshadapt)", "--output"},
    {"--no-peers", "", "does not run Mmg, even if it is on the PATH"},
    {"--help", "", "says this and lists the cases", "-h"},
}};

/// The cases of a full run: all, and the waves at ten times the size.
std::vector<std::string> usual_cases() {
  std::vector<std::string> names;
  for (const CaseInfo& info : known_cases()) names.emplace_back(info.name);
  names.insert(names.end(), {"psi2d@10", "psi3d@10"});
  return names;
}

/// All cases, the large ones made small.
std::vector<std::string> quick_cases() {
  std::vector<std::string> names;
  for (const CaseInfo& info : known_cases())
    names.push_back(times(std::string(info.name), info.complexity > 20000 ? 0.05 : 1));
  names.emplace_back("psi2d@0.5");
  return names;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

/// The factor in the name NAME@FACTOR; 1 if there is none.
double factor_of(const std::string& name) {
  const std::size_t at = name.find('@');
  return at == std::string::npos ? 1 : std::strtod(name.c_str() + at + 1, nullptr);
}

}  // namespace

std::span<const cli::Option> plan_options() { return options; }

Plan plan_from(const cli::Arguments& arguments) {
  if (!arguments.operands().empty())
    throw cli::UsageError("expected options only, found '" + arguments.operands()[0] + "'");
  const bool quick = arguments.has("--quick");
  Plan plan{.cases = quick ? quick_cases() : usual_cases(),
            .folder = arguments.text("-o").value_or("bench-results/meshadapt")};
  if (const auto list = arguments.text("--cases")) plan.cases = split(*list);
  for (std::string& name : plan.cases)
    name = times(name, arguments.positive("--scale").value_or(1));
  plan.most_threads = arguments.integer("--threads", 1, 4096).value_or(runtime::available_cores());
  plan.repetitions = arguments.integer("--repetitions", 1, 1000).value_or(quick ? 2 : 5);
  plan.pairs = std::min(plan.repetitions, quick ? 1 : 3);
  plan.seconds = arguments.positive("--seconds").value_or(quick ? 6 : 120);
  plan.peers = !arguments.has("--no-peers");
  return plan;
}

std::vector<RunSettings> settings_for(const Plan& plan, const std::string& case_name) {
  const int most = plan.most_threads;
  if (is_large(case_name)) return {{most, Mode::tiles}};
  std::vector<RunSettings> settings;
  for (int threads = 1; threads < most; threads *= 2) settings.push_back({threads, Mode::tiles});
  settings.push_back({most, Mode::tiles});
  settings.push_back({1, Mode::colours});
  if (most > 1) settings.push_back({most, Mode::colours});
  return settings;
}

bool is_large(const std::string& case_name) { return factor_of(case_name) > 1; }

}  // namespace ductile::bench
