#include "words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

namespace ductile::bench::report {
namespace {

/// Not in powers of ten, however large or small; two digits, where less than one.
std::string three_digits(double value) {
  std::array<char, 64> text{};
  const int power = value > 0 ? static_cast<int>(std::floor(std::log10(value))) : 0;
  const int decimals = power < -1 ? 1 - power : 2 - std::max(0, power);
  std::snprintf(text.data(), text.size(), "%.*f", std::max(0, decimals), value);
  return text.data();
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

double geometric_mean(const std::vector<double>& ratios) {
  double sum = 0;
  for (const double ratio : ratios) sum += std::log(ratio);
  return std::exp(sum / static_cast<double>(ratios.size()));
}

std::string name_for(const Figure& figure, By by) {
  return by == By::library ? library_of(figure.candidate) : figure.candidate;
}

/// The first of each name, which is its fastest.
std::vector<std::pair<std::string, const Figure*>> best_of_each(const Contest& contest, By by) {
  std::vector<std::pair<std::string, const Figure*>> best;
  for (const Figure& figure : contest.figures) {
    const std::string name = name_for(figure, by);
    const bool is_new =
        std::none_of(best.begin(), best.end(), [&](const auto& one) { return one.first == name; });
    if (is_new) best.emplace_back(name, &figure);
  }
  return best;
}

std::string winners_sentence(const std::vector<Standing>& all) {
  std::string text;
  for (const Standing& standing : all)
    if (!standing.won.empty())
      text += (text.empty() ? "Fastest beyond the spread of its samples: " : "; ") + standing.who +
              " in " + std::to_string(standing.won.size()) + " (" + joined(standing.won) + ')';
  return text.empty() ? "Nobody was fastest beyond the spread of the samples." : text + '.';
}

std::string par_sentence(std::span<const Contest> contests) {
  std::string text;
  for (const Contest& contest : contests) {
    if (contest.clear() || !contest.decided()) continue;
    std::vector<std::string> names;
    for (const Figure& figure : contest.figures)
      if (figure.on_par) names.push_back(figure.candidate);
    text += (text.empty() ? "On a par: " : "; ") + contest.case_name + ": " + joined(names);
  }
  return text.empty() ? text : text + '.';
}

std::string undecided_sentence(std::span<const Contest> contests) {
  std::vector<std::string> cases;
  for (const Contest& contest : contests) {
    if (contest.decided()) continue;
    const Figure& best = contest.best();
    cases.push_back(contest.case_name + " (" + best.candidate + ", " +
                    (best.mixed
                         ? "none of " + std::to_string(best.samples) + " at the usual distance"
                         : samples_words(best)) +
                    ')');
  }
  if (cases.empty()) return "";
  return "Not decided, because fewer than " + std::to_string(enough_samples) +
         " samples of the one that seems fastest count: " + joined(cases) + '.';
}

/// Nobody can be faster than the floor, so that somebody made a mistake.
std::string below_floor_sentence(std::span<const Contest> contests) {
  std::string text;
  for (const Contest& contest : contests) {
    std::vector<std::string> names;
    for (const Figure& figure : contest.figures)
      if (figure.below_floor)
        names.push_back(figure.candidate + ' ' + time_words(figure.median_ns));
    if (names.empty()) continue;
    text += (text.empty() ? "Below the floor by more than the spread, so that either the floor or "
                            "the measurement is wrong: "
                          : "; ") +
            contest.case_name + " (floor " + time_words(contest.floor->median_ns) +
            "): " + joined(names);
  }
  return text.empty() ? text : text + '.';
}

std::string mean_sentence(std::vector<Standing> all, std::size_t cases) {
  std::sort(all.begin(), all.end(),
            [](const Standing& a, const Standing& b) { return a.over_best < b.over_best; });
  std::vector<std::string> words;
  words.reserve(all.size());
  for (const Standing& standing : all)
    words.push_back(
        standing.who + ' ' + ratio_words(standing.over_best) +
        (standing.cases < cases ? " (" + std::to_string(standing.cases) + " cases)" : ""));
  return "Time over that of the best, geometric mean of the cases: " + joined(words) + '.';
}

std::string floor_sentence(std::span<const Contest> contests) {
  std::vector<double> ratios;
  for (const Contest& contest : contests)
    if (contest.floor) ratios.push_back(*contest.best().over_floor);
  if (ratios.empty()) return "";
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  std::string text = "The fastest took " + ratio_words(*least);
  if (ratios.size() > 1)
    text += " to " + ratio_words(*most) + " times the floor, in the geometric mean " +
            ratio_words(geometric_mean(ratios));
  return text + (ratios.size() > 1 ? "." : " times the floor.");
}

}  // namespace

std::string ratio_words(double ratio) {
  const std::pair<double, const char*> units[] = {{1e9, " billion"}, {1e6, " million"}};
  for (const auto& [unit, name] : units)
    if (ratio >= unit) return three_digits(ratio / unit) + name;
  return three_digits(ratio);
}

std::string samples_words(const Figure& figure) {
  std::string text = std::to_string(figure.samples);
  if (figure.left_out > 0) text += " of " + std::to_string(figure.samples + figure.left_out);
  return text + (figure.mixed ? ", distances mixed" : "");
}

std::string time_words(double ns) {
  const std::pair<double, const char*> units[] = {{1e9, " s"}, {1e6, " ms"}, {1e3, " us"}};
  for (const auto& [unit, name] : units)
    if (ns >= 0.9995 * unit) return three_digits(ns / unit) + name;
  return three_digits(ns) + " ns";
}

std::vector<Standing> standings(std::span<const Contest> contests, By by) {
  std::map<std::string, Standing> standing_of;
  std::map<std::string, std::vector<double>> ratios_of;
  for (const Contest& contest : contests) {
    const auto takers = best_of_each(contest, by);
    const auto equals = std::count_if(takers.begin(), takers.end(),
                                      [](const auto& taker) { return taker.second->on_par; });
    for (const auto& [who, figure] : takers) {
      Standing& standing = standing_of[who];
      standing.who = who;
      ++standing.cases;
      ratios_of[who].push_back(figure->over_best);
      if (!figure->on_par) continue;
      (!contest.decided() ? standing.undecided
       : equals == 1      ? standing.won
                          : standing.on_par)
          .push_back(contest.case_name);
    }
  }
  std::vector<Standing> all;
  for (auto& [who, standing] : standing_of) {
    standing.over_best = geometric_mean(ratios_of[who]);
    all.push_back(std::move(standing));
  }
  std::sort(all.begin(), all.end(), [](const Standing& a, const Standing& b) {
    return std::pair(a.won.size(), -a.over_best) > std::pair(b.won.size(), -b.over_best);
  });
  return all;
}

std::vector<std::string> sentences(std::span<const Contest> contests) {
  const std::vector<Standing> all = standings(contests, By::candidate);
  std::vector<std::string> said = {
      winners_sentence(all),        par_sentence(contests),
      undecided_sentence(contests), mean_sentence(all, contests.size()),
      floor_sentence(contests),     below_floor_sentence(contests)};
  std::erase(said, "");
  return said;
}

}  // namespace ductile::bench::report
