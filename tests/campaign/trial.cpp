#include "trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "child.hpp"
#include "exact.hpp"
#include "mesh_file.hpp"
#include "random.hpp"

namespace ductile::campaign {
namespace {

constexpr double moved_at_rest = 0.02;  // share of the elements
constexpr double growth_allowed =
    1.5;  // ratio of the numbers of elements after the last and the first call
constexpr std::size_t few_elements = 50;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream all;
  all << file.rdbuf();
  return all.str();
}

/// Elements as positions of their corners, in ascending order.
std::vector<std::vector<Point>> places(const Mesh& mesh) {
  std::vector<std::vector<Point>> all;
  for (const Cell& element : mesh.elements().corners) {
    std::vector<Point> place;
    for (const int vertex : element)
      if (vertex >= 0) place.push_back(mesh.points[static_cast<std::size_t>(vertex)]);
    std::sort(place.begin(), place.end());
    all.push_back(std::move(place));
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::size_t count_changed(const Mesh& before, const Mesh& after) {
  const auto old_places = places(before), new_places = places(after);
  std::vector<std::vector<Point>> changed;
  std::set_difference(new_places.begin(), new_places.end(), old_places.begin(), old_places.end(),
                      std::back_inserter(changed));
  return changed.size();
}

class Trial {
 public:
  Trial(const Case& tried, std::uint64_t seed, const std::filesystem::path& folder,
        const Settings& settings)
      : case_(tried), random_(seed ^ 0x5bd1e995U), folder_(folder), settings_(settings) {
    std::filesystem::create_directories(folder);
    script_.open(folder / "run.sh");
    script_ << "#!/bin/sh\n# Repeats the calls of this trial (" << tried.kind
            << "); DUCTILE=program ./run.sh\ncd \"$(dirname \"$0\")\"\n";
  }

  Outcome make() {
    write_mesh(folder_ / "in.mesh", case_.mesh);
    if (case_.metric) write_field(folder_ / "in.sol", *case_.metric);
    const std::string threads = std::to_string(random_.pick({1, 1, 2, 3}));
    if (!adapt("in", "out", threads, case_.options)) return outcome_;
    Mesh adapted;
    if (!check("out", 1, adapted)) return outcome_;
    check_unrounded(adapted);
    if (settings_.all_checks || random_.chance(0.2)) check_threads(threads);
    if (settings_.all_checks || case_.metric || random_.chance(0.25)) check_info();
    if (settings_.all_checks || random_.chance(0.25)) check_closure(adapted);
    if (settings_.level_sets && !case_.mesh.surface &&
        (settings_.all_checks || random_.chance(0.2)))
      check_level_set();
    return outcome_;
  }

 private:
  // ---- Running ----

  /// Runs `ductile WORDS`; false, and a verdict, if it did not end with exit status 0.
  bool run_program(std::vector<std::string> words) {
    script_ << "\"${DUCTILE:-ductile}\"";
    for (const std::string& word : words) script_ << ' ' << word;
    script_ << std::endl;
    words.insert(words.begin(), settings_.program.string());
    const Ending ending = run(words, folder_, settings_.limit_s);
    outcome_.seconds = std::max(outcome_.seconds, ending.seconds);
    if (ending.how == Ending::How::timed_out) {
      fail(Verdict::timeout, "timeout: not done in " + std::to_string(settings_.limit_s) + " s");
    } else if (ending.how == Ending::How::crashed) {
      fail(Verdict::crash, "crash: ended by signal or status " + std::to_string(ending.status) +
                               ": " + last_line(ending.message));
    } else if (ending.status != 0) {
      refuse(ending);
    } else {
      return true;
    }
    return false;
  }

  /// An indented line says what to do about the one above, so both count as one.
  static std::string last_line(std::string text) {
    for (std::size_t at; (at = text.find("\n  ")) != std::string::npos;) text.replace(at, 3, "; ");
    const std::size_t end = text.find_last_not_of('\n');
    if (end == std::string::npos) return "(no message)";
    const std::size_t begin = text.rfind('\n', end);
    return text.substr(begin == std::string::npos ? 0 : begin + 1,
                       end - (begin == std::string::npos ? std::string::npos : begin));
  }

  void refuse(const Ending& ending) {
    const std::string line = last_line(ending.message);
    const bool allowed =
        std::any_of(case_.refusals.begin(), case_.refusals.end(),
                    [&](const std::string& word) { return line.find(word) != std::string::npos; });
    fail(allowed && prefix_.empty() ? Verdict::refused : Verdict::wrong,
         "refused: exit status " + std::to_string(ending.status) + ": " + line);
  }

  void fail(Verdict verdict, const std::string& why) {
    outcome_.verdict = std::max(outcome_.verdict, verdict);
    outcome_.faults.push_back(prefix_ + why);
  }

  bool adapt(const std::string& from, const std::string& to, const std::string& threads,
             const std::vector<std::string>& options) {
    std::vector<std::string> words = {"adapt",      from + ".mesh", "-o",
                                      to + ".mesh", "--threads",    threads};
    words.insert(words.end(), options.begin(), options.end());
    const auto has = [&](const char* word) {
      return std::find(options.begin(), options.end(), word) != options.end();
    };
    const bool has_size = has("-hsiz") || has("-A");
    if (!has_size && std::filesystem::exists(folder_ / (from + ".sol")))
      words.insert(words.end(), {"-sol", from + ".sol"});
    return run_program(words);
  }

  // ---- Checking ----

  /// Reads the output of call number `calls` and checks it against the input.
  bool check(const std::string& name, int calls, Mesh& adapted) {
    Promise promise = case_.promise;
    promise.tolerance *= calls;
    Faults faults;
    try {
      adapted = read_mesh(folder_ / (name + ".mesh"));
      faults = check_all(case_.mesh, adapted, promise);
      if (std::filesystem::exists(folder_ / (name + ".sol"))) {
        const Faults more = check_metric(adapted, read_field(folder_ / (name + ".sol")), promise);
        faults.insert(faults.end(), more.begin(), more.end());
      }
    } catch (const BadFile& error) {
      faults = {std::string("file: ") + error.what()};
    }
    for (const std::string& fault : faults) fail(Verdict::wrong, fault);
    return faults.empty();
  }

  /// Rounding coordinates must not change the number of elements.
  void check_unrounded(const Mesh& adapted) {
    if (!case_.unrounded) return;
    prefix_ = "unrounded: ";
    write_mesh(folder_ / "exact.mesh", *case_.unrounded);
    if (case_.metric) write_field(folder_ / "exact.sol", *case_.metric);
    if (!adapt("exact", "exact.out", "1", case_.options)) return;
    const std::size_t exact = read_mesh(folder_ / "exact.out.mesh").elements().size();
    const std::size_t rounded = adapted.elements().size();
    if (std::max(exact, rounded) > 1.3 * std::min(exact, rounded) + few_elements)
      fail(Verdict::wrong, "lengths: " + std::to_string(exact) + " elements, but " +
                               std::to_string(rounded) + " with coordinates rounded");
    prefix_.clear();
  }

  void check_threads(const std::string& used) {
    if (!case_.deterministic) return;
    for (const std::string threads : {"1", "2", "3"}) {
      if (threads == used) continue;
      prefix_ = "on " + threads + " threads: ";
      if (!adapt("in", "threads", threads, case_.options)) return;
      for (const std::string ending : {".mesh", ".sol"})
        if (contents(folder_ / ("out" + ending)) != contents(folder_ / ("threads" + ending)))
          fail(Verdict::wrong, "determinism: not the same on " + used);
    }
    prefix_.clear();
  }

  void check_info() {
    prefix_ = "info: ";
    std::vector<std::string> words = {"info", "out.mesh"};
    if (std::filesystem::exists(folder_ / "out.sol"))
      words.insert(words.end(), {"-sol", "out.sol"});
    run_program(words);
    prefix_.clear();
  }

  /// Adapts the result twice more; the last call should change little.
  void check_closure(const Mesh& first) {
    Mesh before = first, after;
    std::string name = "out";
    for (int call = 2; call <= 3; ++call) {
      prefix_ = "call " + std::to_string(call) + ": ";
      const std::string next = "out" + std::to_string(call);
      if (!adapt(name, next, "1", case_.options) || !check(next, call, after)) return;
      name = next;
      if (call == 3) break;
      before = after;
    }
    if (case_.rests) {
      outcome_.closed = true;
      outcome_.rested = static_cast<double>(count_changed(before, after)) <=
                        moved_at_rest * static_cast<double>(after.elements().size());
    }
    if (static_cast<double>(after.elements().size()) >
        growth_allowed * static_cast<double>(first.elements().size() + few_elements))
      fail(Verdict::wrong, "growth: " + std::to_string(first.elements().size()) +
                               " elements, then " + std::to_string(after.elements().size()));
    prefix_.clear();
  }

  /// Waves in random directions, sometimes with kinks or with zeros at points.
  Field level_set() {
    Point low = case_.mesh.points[0], high = low;
    for (const Point& point : case_.mesh.points)
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], point[i]);
        high[i] = std::max(high[i], point[i]);
      }
    const double extent = norm(high - low), shift = random_.uniform(-1, 1);
    const std::array<Point, 2> waves = {random_.uniform(2, 15) * random_.axes(3)[0],
                                        random_.uniform(2, 15) * random_.axes(3)[1]};
    const double steps = random_.pick({0, 0, 4}), kink = random_.pick({0.0, 0.0, 0.5});
    Field field{case_.mesh.dimension, 1, {}};
    for (const Point& point : case_.mesh.points) {
      const Point place = (1 / extent) * (point - low);
      double value = std::sin(dot(waves[0], place)) + std::cos(dot(waves[1], place)) + shift;
      if (kink > 0) value = std::abs(value) - kink;
      field.values.push_back(steps > 0 ? std::round(steps * value) / steps : value);
    }
    return field;
  }

  /// A mesh that was cut must be a mesh, and must be adapted like any other. Cases with required
  /// entities, which may not be cut, are left out.
  void check_level_set() {
    for (const auto& [name, list] : case_.mesh.lists)
      if (name.starts_with("Required") && !list.empty()) return;
    prefix_ = "level set: ";
    write_field(folder_ / "phi.sol", level_set());
    std::vector<std::string> words = {"adapt",     "in.mesh",   "-ls",     "-sol",
                                      "phi.sol",   "-noinsert", "-noswap", "-nomove",
                                      "--threads", "2",         "-o",      "cut.mesh"};
    const auto is_size = [](const std::string& word) { return word == "-hsiz" || word == "-A"; };
    const bool has_size = std::any_of(case_.options.begin(), case_.options.end(), is_size);
    if (case_.metric && !has_size) words.insert(words.end(), {"-met", "in.sol"});
    for (const char* option : {"-hmin", "-hmax"}) {  // which a metric may need
      const auto at = std::find(case_.options.begin(), case_.options.end(), option);
      if (at != case_.options.end()) words.insert(words.end(), {at[0], at[1]});
    }
    if (case_.promise.unlisted_boundary) words.push_back("--complete-boundary");
    if (!run_program(words)) return;
    const Mesh cut = read_mesh(folder_ / "cut.mesh");
    for (const std::string& fault : check_structure(cut, case_.promise.unlisted_boundary))
      fail(Verdict::wrong, fault);
    if (!adapt("cut", "cut.out", "2", case_.options)) return;
    for (const std::string& fault :
         check_all(cut, read_mesh(folder_ / "cut.out.mesh"), case_.promise))
      fail(Verdict::wrong, fault);
    prefix_.clear();
  }

  const Case& case_;
  Random random_;
  const std::filesystem::path& folder_;
  const Settings& settings_;
  std::ofstream script_;
  std::string prefix_;
  Outcome outcome_;
};

}  // namespace

Outcome try_case(const Case& tried, std::uint64_t seed, const std::filesystem::path& folder,
                 const Settings& settings) {
  return Trial(tried, seed, folder, settings).make();
}

}  // namespace ductile::campaign
