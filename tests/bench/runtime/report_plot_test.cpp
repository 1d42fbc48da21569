#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <utility>

#include "axis.hpp"
#include "contests.hpp"
#include "marks.hpp"
#include "page.hpp"
#include "plot.hpp"
#include "report_samples.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

using Candidates = std::vector<std::string>;

/// Each subject has one case.
Contests contests_of(const std::map<std::string, Candidates>& by_subject) {
  std::vector<Sample> all;
  for (const auto& [subject, candidates] : by_subject)
    for (const std::string& candidate : candidates) {
      all.push_back(sample(candidate, 1, 100));
      all.back().name.subject = subject;
    }
  return hold_contests(all);
}

/// What of a mark is seen.
std::string look(const Style& style) {
  std::ostringstream svg;
  draw_mark(svg, style, {0, 0}, "");
  return svg.str();
}

/// In every plot no two candidates look the same; a library has one colour in all plots. Returns
/// how many libraries share their colour with another of the same plot.
std::size_t check_looks(const Contests& held) {
  std::map<std::string, std::string> colour_of;
  std::size_t shared = 0;
  for (const Section& section : sections(held)) {
    std::set<std::string> looks;
    std::map<std::string, std::string> library_in;  // [colour]
    for (const auto& [candidate, style] : styles(section, held.contests)) {
      EXPECT_TRUE(looks.insert(look(style)).second) << candidate << ": " << look(style);
      const std::string library = library_of(candidate);
      EXPECT_EQ(colour_of.emplace(library, style.colour).first->second, style.colour) << candidate;
      shared += library_in.emplace(style.colour, library).first->second != library ? 1 : 0;
    }
  }
  return shared;
}

TEST(ReportMarks, NoTwoCandidatesOfAPlotLookTheSame) {
  std::mt19937 random(38);
  const auto up_to = [&](int most) { return std::uniform_int_distribution<int>(1, most)(random); };
  for (int trial = 0; trial < 100; ++trial) {
    std::map<std::string, Candidates> by_subject;
    const int libraries = up_to(30), methods = up_to(trial % 10 == 0 ? 60 : 12);
    for (int subject = up_to(4); subject > 0; --subject)
      for (int library = up_to(libraries); library > 0; --library)
        for (int method = up_to(methods); method > 0; --method)
          by_subject["s" + std::to_string(subject)].push_back("l" + std::to_string(library) + ".m" +
                                                              std::to_string(method));
    const std::size_t shared = check_looks(contests_of(by_subject));
    if (libraries <= 10) {
      EXPECT_EQ(shared, 0U);
    }
  }
}

/// Eleven libraries and ten colours: `arrays` and `tbb` had one colour and the same mark.
TEST(ReportMarks, LibrariesThatMeetHaveColoursOfTheirOwn) {
  const Contests held = contests_of(
      {{"buffers",
        {"arrays.read_back", "atomic.fetch_add", "ductile.deferred", "mutex.one", "mutex.striped",
         "prefix_sum.two_passes", "tbb.concurrent_vector"}},
       {"colouring", {"boost.sequential", "ductile.serial", "ductile.automatic", "kokkos.vb"}},
       {"loops",
        {"ductile.atomics", "ductile.automatic", "ductile.omp_dynamic", "ductile.omp_guided",
         "ductile.omp_static", "ductile.signal", "ductile.team", "gomp.static", "libomp.static",
         "tbb.auto"}},
       {"worklists", {"ductile.arrival", "mutex.push_back", "std.push_back", "tbb.push_back"}}});
  EXPECT_EQ(check_looks(held), 0U);
}

/// The marks of some twenty candidates differ even to those who see no colours.
TEST(ReportMarks, DifferWithoutColoursWhileThereAreEnough) {
  Candidates some;
  for (std::size_t i = 0; i < outline_count; ++i)
    some.push_back("l" + std::to_string(i % 5) + ".m" + std::to_string(i));
  std::set<std::size_t> marks;
  const Contests held = contests_of({{"subject", some}});
  for (const auto& [candidate, style] : styles(held.contests, held.contests))
    marks.insert(style.mark);
  EXPECT_EQ(marks.size(), outline_count);
}

/// Of a mark's title, the horizontal place of the mark.
double place_of_mark(const std::string& svg, const std::string& title) {
  const std::size_t end = svg.find("<title>" + title);
  const std::string key = "translate(";
  const std::size_t begin = svg.rfind(key, end) + key.size();
  return end == std::string::npos ? -1 : std::stod(svg.substr(begin));
}

TEST(ReportPlot, PutsRatiosOnALogarithmicAxis) {
  const Contests held = hold_contests(samples({sample("a.x", 2, 100), sample("b.y", 2, 200),
                                               sample("c.z", 2, 400), sample("floor", 2, 50)}));
  const std::string svg = plot(held.contests, held.contests);
  const double x = place_of_mark(svg, "a.x 100 ns"), y = place_of_mark(svg, "b.y 200 ns");
  EXPECT_GT(x, 0);
  EXPECT_GT(y, x);
  EXPECT_NEAR(place_of_mark(svg, "c.z 400 ns") - y, y - x, 0.1);
}

/// Candidates c0, c1, ... of several cases at these ratios to the floor.
Contests contests_at(const std::vector<std::vector<double>>& ratios_by_case, bool with_floor) {
  std::vector<Sample> medians;
  const auto add = [&](std::size_t number, const std::string& who, double ns) {
    medians.push_back(sample(who, 2, ns));
    medians.back().name.case_name = "case" + std::to_string(number);
  };
  std::size_t number = 0;
  for (const std::vector<double>& ratios : ratios_by_case) {
    for (std::size_t c = 0; c < ratios.size(); ++c)
      add(number, "c" + std::to_string(c), 1000 * ratios[c]);
    if (with_floor) add(number, "floor", 1000);
    ++number;
  }
  return hold_contests(samples(medians));
}

/// The axis has room for the usual ratios, and shows the unusual at its edges, with the ratio.
void check_outlier(const std::vector<std::vector<double>>& ratios, double outlier, bool floor) {
  const Contests held = contests_at(ratios, floor);
  const Axis axis(held.contests);
  EXPECT_LE(axis.ticks().back() / axis.ticks().front(), 5000);
  EXPECT_GT(axis.place(2) - axis.place(1), 0.08);
  const std::string svg = plot(held.contests, held.contests);
  EXPECT_NE(svg.find(ratio_words(outlier)), std::string::npos) << svg;
  const auto x_of = [&](const Figure& figure) {
    return place_of_mark(svg, figure.candidate + ' ' + time_words(figure.median_ns));
  };
  const Figure& usual = held.contests.front().figures[outlier < 1 ? 1 : 0];
  const double begin = x_of(usual) - 520 * axis.place(ratio_of(usual));
  for (const Contest& contest : held.contests)
    for (const Figure& figure : contest.figures) {
      const double ratio = ratio_of(figure);
      EXPECT_EQ(axis.is_beyond(ratio), ratio > 200) << ratio;
      EXPECT_EQ(axis.is_below(ratio), ratio < 0.05) << ratio;
      EXPECT_NEAR(x_of(figure), begin + 520 * axis.place(ratio), 0.5) << ratio;
    }
}

TEST(ReportPlot, OneOutlierDoesNotStretchTheAxis) {
  for (const double outlier : {1e-9, 1e-6, 1e-3, 1e3, 1e6, 3e12})
    for (const std::vector<std::vector<double>>& ratios :
         {std::vector<std::vector<double>>{{1, 2, outlier}},
          {{1, 1.5, 3, 20, outlier}, {1.1, 2, 3}, {1, 1, 1}},
          {{1.3, outlier}, {2, 1}},
          {{1, 2}, {1, 2}, {outlier}},  // a case whose floor is wrong
          {{1, outlier}, {2, outlier}, {1.2, outlier}}}) {
      check_outlier(ratios, outlier, true);
      // Without a floor the best of each case is at 1.
      const bool best_is_one = outlier > 1 && ratios.front().front() == 1 && ratios.size() < 3;
      if (best_is_one) check_outlier(ratios, outlier, false);
    }
}

/// Outliers at random: those of a case stand in the order of their ratios, none on another.
TEST(ReportPlot, OutliersStandBesideEachOther) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> usual(0, 1), unusual(3, 9);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> ratios = {1, 1};
    for (int i = 0; i < 3; ++i) ratios.push_back(std::pow(10, usual(random)));
    for (int i = 0; i < trial % 7; ++i) ratios.push_back(std::pow(10, unusual(random)));
    const Contests held = contests_at({ratios}, trial % 2 == 0);
    const std::string svg = plot(held.contests, held.contests);
    std::vector<double> places;
    for (const Figure& figure : held.contests.front().figures)
      places.push_back(place_of_mark(svg, figure.candidate + ' ' + time_words(figure.median_ns)));
    EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
    for (std::size_t i = 6; i < places.size(); ++i) EXPECT_GT(places[i] - places[i - 1], 9);
  }
}

TEST(ReportPlot, AFewOutliersHaveARatioEach) {
  const auto words_at = [](const std::vector<double>& ratios, const std::string& words) {
    const Contests held = contests_at({ratios}, true);
    return plot(held.contests, held.contests).find('>' + words + '<') != std::string::npos;
  };
  EXPECT_TRUE(words_at({1, 2, 300, 4e6}, "300, 4.00 million"));
  EXPECT_TRUE(words_at({1, 2, 300, 400, 5000, 4e6}, "300 to 4.00 million"));
  EXPECT_TRUE(words_at({0.00012, 1, 2, 3}, "0.00012"));
}

}  // namespace
}  // namespace ductile::bench::report
