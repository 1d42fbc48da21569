#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <utility>

#include "axis.hpp"
#include "contests.hpp"
#include "contests_page.hpp"
#include "marks.hpp"
#include "plot.hpp"
#include "report/gnuplot.hpp"
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
std::string look(const Style& style) { return label(style, "first 1, first 0"); }

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

std::string script_of(const Contests& held) {
  return plot("plot.svg", held.contests, held.contests);
}

/// Where the mark of a figure is: on the axis at its ratio, or beside it, as a part of the picture.
struct Place {
  bool on_axis = false;
  double x = -1;
};

Place place_of(const std::string& script, const Figure& figure) {
  const std::size_t says =
      script.find("  # " + figure.candidate + ' ' + time_words(figure.median_ns) + '\n');
  if (says == std::string::npos) return {};
  std::istringstream place(script.substr(script.rfind(" at ", says) + 4));
  std::string coordinates;
  double x = -1;
  place >> coordinates >> x;
  return {coordinates == "first", x};
}

/// Where the axis begins or ends, as a part of the picture.
double margin(const std::string& script, const std::string& name) {
  const std::string key = name + " at screen ";
  return std::stod(script.substr(script.find(key) + key.size()));
}

TEST(ReportPlot, PutsRatiosOnALogarithmicAxis) {
  const Contests held = hold_contests(samples({sample("a.x", 2, 100), sample("b.y", 2, 200),
                                               sample("c.z", 2, 400), sample("floor", 2, 50)}));
  const std::string script = script_of(held);
  EXPECT_NE(script.find("set logscale x\n"), std::string::npos);
  for (const Figure& figure : held.contests.front().figures) {
    EXPECT_TRUE(place_of(script, figure).on_axis) << figure.candidate;
    EXPECT_NEAR(place_of(script, figure).x, ratio_of(figure), 1e-4) << figure.candidate;
  }
}

/// Three candidates in one case and the legend: six marks, of which three are at equal distances.
TEST(ReportPlot, IsWhatGnuplotUnderstands) {
  const Contests held = hold_contests(samples({sample("it's.x", 2, 100), sample("b<&.y", 2, 200),
                                               sample("c.z", 2, 400), sample("floor", 2, 50)}));
  const Folder folder;
  const auto script = folder.write("plots.gp", script_of(held));
  if (!draw_plots(script, script.parent_path())) GTEST_SKIP() << "gnuplot is not there";
  std::ifstream picture(script.parent_path() / "plot.svg");
  std::vector<double> places;
  std::string svg;
  for (std::string line; std::getline(picture, line); svg += line)
    if (const auto mark = line.find("<use "); mark != std::string::npos)
      if (const auto at = line.find("translate(", mark); at != std::string::npos)
        places.push_back(std::stod(line.substr(at + 10)));
  ASSERT_EQ(places.size(), 6U) << svg;
  std::sort(places.begin(), places.begin() + 3);
  EXPECT_GT(places[1], places[0] + 20);
  EXPECT_NEAR(places[2] - places[1], places[1] - places[0], 0.2);
  for (const char* const text : {"it's.x", "b&lt;&amp;.y", "time over the floor"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
}

TEST(ReportPlot, SaysWhereThereIsNothingToDraw) {
  const Folder folder;
  const auto script = folder.write("plots.gp", "set no_such_option\n");
  EXPECT_FALSE(draw_plots(script, script.parent_path()));
  EXPECT_FALSE(draw_plots(script.parent_path() / "none.gp", script.parent_path()));
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
  const std::string script = script_of(held);
  EXPECT_NE(script.find(ratio_words(outlier)), std::string::npos) << script;
  for (const Contest& contest : held.contests)
    for (const Figure& figure : contest.figures) {
      const double ratio = ratio_of(figure);
      EXPECT_EQ(axis.is_beyond(ratio), ratio > 200) << ratio;
      EXPECT_EQ(axis.is_below(ratio), ratio < 0.05) << ratio;
      const Place place = place_of(script, figure);
      EXPECT_EQ(place.on_axis, ratio >= 0.05 && ratio <= 200) << ratio;
      if (place.on_axis) {
        EXPECT_NEAR(place.x, ratio, 1e-5 * ratio);
      } else if (ratio < 1) {
        EXPECT_NEAR(place.x, margin(script, "lmargin"), 1e-5);
      } else {
        EXPECT_NEAR(place.x, margin(script, "rmargin"), 1e-5);
      }
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
    const std::string script = script_of(held);
    std::vector<double> places;
    for (const Figure& figure : held.contests.front().figures)
      if (const Place place = place_of(script, figure); !place.on_axis) places.push_back(place.x);
    EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
    EXPECT_EQ(places.size(), static_cast<std::size_t>(trial % 7));
    // Pictures are at most 2,000 pixels wide.
    for (std::size_t i = 1; i < places.size(); ++i)
      EXPECT_GT(2000 * (places[i] - places[i - 1]), 9);
  }
}

TEST(ReportPlot, AFewOutliersHaveARatioEach) {
  const auto words_at = [](const std::vector<double>& ratios, const std::string& words) {
    const Contests held = contests_at({ratios}, true);
    return script_of(held).find(quoted(words)) != std::string::npos;
  };
  EXPECT_TRUE(words_at({1, 2, 300, 4e6}, "300, 4.00 million"));
  EXPECT_TRUE(words_at({1, 2, 300, 400, 5000, 4e6}, "300 to 4.00 million"));
  EXPECT_TRUE(words_at({0.00012, 1, 2, 3}, "0.00012"));
}

}  // namespace
}  // namespace ductile::bench::report
