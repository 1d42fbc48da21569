#include "contests.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace ductile::bench::report {
namespace {

Distance distance_at(double round_trip_ns) {
  if (round_trip_ns <= 0) return Distance::moved;
  if (round_trip_ns < 75) return Distance::same_core;
  return round_trip_ns < 200 ? Distance::near : Distance::far;
}

/// Between the values next to it; sorts them.
double quantile(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

Distance usual_distance(const std::vector<Sample>& samples) {
  std::map<Distance, std::size_t> count;
  for (const Sample& sample : samples)
    if (sample.name.threads > 1 && distance_of(sample) != Distance::moved)
      ++count[distance_of(sample)];
  const auto most = std::max_element(
      count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? Distance::unknown : most->first;
}

using Group = std::vector<const Sample*>;  // of one benchmark

Figure figure_of(const Group& group, Distance usual) {
  Group counted;
  for (const Sample* const sample : group)
    if (sample->name.threads == 1 || distance_of(*sample) == usual) counted.push_back(sample);
  Figure figure;
  figure.candidate = group.front()->name.candidate;
  figure.threads = group.front()->name.threads;
  figure.mixed = counted.empty();
  if (figure.mixed) counted = group;
  figure.samples = counted.size();
  figure.left_out = group.size() - counted.size();
  std::vector<double> times;
  std::map<std::string, std::vector<double>> counters;
  for (const Sample* const sample : counted) {
    times.push_back(sample->ns);
    for (const auto& [name, value] : sample->counters) counters[name].push_back(value);
  }
  figure.median_ns = quantile(times, 0.5);
  figure.low_ns = quantile(times, 0.25);
  figure.high_ns = quantile(times, 0.75);
  for (auto& [name, values] : counters) figure.counters[name] = quantile(values, 0.5);
  return figure;
}

/// What was measured of one subject and case: figures by candidate, then by threads.
struct Measured {
  std::string subject, case_name;
  std::map<std::string, std::map<int, Figure>> figure_of;
};

/// By subject, then case.
std::vector<Measured> measure(const std::vector<Sample>& samples, Distance usual) {
  std::map<std::pair<std::string, std::string>, std::map<std::pair<std::string, int>, Group>> all;
  for (const Sample& sample : samples) {
    const auto& [subject, case_name, candidate, threads] = sample.name;
    all[{subject, case_name}][{candidate, threads}].push_back(&sample);
  }
  std::vector<Measured> measured;
  for (const auto& [key, groups] : all) {
    Measured& one = measured.emplace_back(Measured{key.first, key.second, {}});
    for (const auto& [name, group] : groups)
      one.figure_of[name.first][name.second] = figure_of(group, usual);
  }
  return measured;
}

/// On so many threads or fewer: where there is little to do, one thread may be the fastest.
std::optional<Figure> lowest_floor(const std::map<int, Figure>& by_threads, int threads) {
  std::optional<Figure> lowest;
  for (const auto& [count, figure] : by_threads)
    if (count <= threads && (!lowest || figure.median_ns < lowest->median_ns)) lowest = figure;
  return lowest;
}

/// Nothing if nobody but the floor takes part.
std::optional<Contest> contest_of(const Measured& measured, int threads) {
  Contest contest{measured.subject, measured.case_name, threads, {}, {}};
  bool anyone = false;
  for (const auto& [candidate, by_threads] : measured.figure_of) {
    if (candidate == floor_name) {
      contest.floor = lowest_floor(by_threads, threads);
      continue;
    }
    const bool serial = by_threads.size() == 1 && by_threads.count(1) > 0;
    const auto found = by_threads.find(serial ? 1 : threads);
    if (found == by_threads.end()) continue;
    contest.figures.push_back(found->second);
    anyone = anyone || found->first == threads;
  }
  if (!anyone) return {};
  std::sort(contest.figures.begin(), contest.figures.end(),
            [](const Figure& a, const Figure& b) { return a.median_ns < b.median_ns; });
  const Figure best = contest.best();
  for (Figure& figure : contest.figures) {
    figure.over_best = figure.median_ns / best.median_ns;
    if (contest.floor) {
      figure.over_floor = figure.median_ns / contest.floor->median_ns;
      figure.below_floor = figure.high_ns < contest.floor->low_ns;
    }
    figure.on_par = figure.low_ns <= best.high_ns || figure.over_best <= 1.03;
  }
  return contest;
}

}  // namespace

Distance distance_of(const Sample& sample) {
  if (!sample.ping_before_ns || !sample.ping_after_ns) return Distance::unknown;
  const Distance before = distance_at(*sample.ping_before_ns);
  return before == distance_at(*sample.ping_after_ns) ? before : Distance::moved;
}

std::string words_for(Distance distance) {
  switch (distance) {
    case Distance::unknown:
      return "at an unknown distance";
    case Distance::moved:
      return "moved";
    case Distance::same_core:
      return "hyperthreads of one core";
    case Distance::near:
      return "near each other";
    case Distance::far:
      return "far from each other";
  }
  return "";
}

bool Contest::clear() const { return decided() && (figures.size() == 1 || !figures[1].on_par); }

Contests hold_contests(const std::vector<Sample>& samples) {
  Contests held;
  held.usual = usual_distance(samples);
  std::map<std::string, std::map<int, std::vector<Contest>>> by_subject;
  for (const Measured& measured : measure(samples, held.usual)) {
    std::set<int> threads;
    for (const auto& [candidate, by_threads] : measured.figure_of)
      for (const auto& [count, figure] : by_threads) threads.insert(count);
    for (const int count : threads)
      if (auto contest = contest_of(measured, count))
        by_subject[measured.subject][count].push_back(std::move(*contest));
  }
  for (auto& [subject, by_threads] : by_subject)
    for (auto& [count, contests] : by_threads)
      std::move(contests.begin(), contests.end(), std::back_inserter(held.contests));
  return held;
}

}  // namespace ductile::bench::report
