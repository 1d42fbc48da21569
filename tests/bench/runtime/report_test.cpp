#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <tuple>

#include "contests.hpp"
#include "contests_page.hpp"
#include "report_samples.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

/// What Google Benchmark 1.7 writes, shortened.
constexpr const char* json = R"({
  "context": {
    "date": "2026-11-21T13:00:00+00:00", "host_name": "secret", "executable": "./loops_bench",
    "num_cpus": 2, "mhz_per_cpu": 2700,
    "caches": [{"type": "Data", "level": 1, "size": 32768, "num_sharing": 1}],
    "load_avg": [1.5, 1.2], "extent": "quick"
  },
  "benchmarks": [
    {"name": "loops/rising/gomp.static/threads:2/real_time",
     "run_name": "loops/rising/gomp.static/threads:2/real_time", "run_type": "iteration",
     "repetitions": 1, "repetition_index": 0, "threads": 1, "iterations": 10,
     "real_time": 1.5e+02, "cpu_time": 1.4e+02, "time_unit": "us",
     "ping_before_ns": 1.1e+02, "ping_after_ns": 1.2e+02, "colours": 7},
    {"name": "loops/rising/gomp.static/threads:2/real_time_mean",
     "run_name": "loops/rising/gomp.static/threads:2/real_time", "run_type": "aggregate",
     "aggregate_name": "mean", "real_time": 9, "cpu_time": 9, "time_unit": "us"},
    {"name": "loops/rising/tbb.auto/threads:2/real_time",
     "run_name": "loops/rising/tbb.auto/threads:2/real_time", "run_type": "iteration",
     "error_occurred": true, "error_message": "items were lost",
     "iterations": 1, "real_time": 1, "cpu_time": 1, "time_unit": "us"},
    {"name": "BM_other", "run_name": "BM_other", "run_type": "iteration", "iterations": 1,
     "real_time": 1, "cpu_time": 1, "time_unit": "ns"}
  ]
})";

TEST(Report, NamesFollowTheConvention) {
  const auto name = parse_name("loops/rising_1e5x200ns/gomp.dynamic/threads:12/real_time");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->subject, "loops");
  EXPECT_EQ(name->case_name, "rising_1e5x200ns");
  EXPECT_EQ(name->candidate, "gomp.dynamic");
  EXPECT_EQ(name->threads, 12);
  EXPECT_EQ(library_of(name->candidate), "gomp");
  EXPECT_EQ(library_of("floor"), "floor");
  for (const char* const wrong : {"", "a/b/c", "a/b/threads:2", "a/b/c/d/threads:2",
                                  "a/b/c/threads:", "a/b/c/threads:2x", "a/b/c/threads:0"})
    EXPECT_FALSE(parse_name(wrong)) << wrong;
}

TEST(Report, ReadsWhatGoogleBenchmarkWrites) {
  const Folder folder;
  const Samples read = read_samples({folder.write("all.json", json)});
  ASSERT_EQ(read.samples.size(), 1U);
  const Sample& only = read.samples.front();
  EXPECT_EQ(only.name.candidate, "gomp.static");
  EXPECT_DOUBLE_EQ(only.ns, 150000);
  EXPECT_DOUBLE_EQ(only.ping_before_ns.value(), 110);
  EXPECT_EQ(only.counters, (std::map<std::string, double>{{"colours", 7}}));
  ASSERT_EQ(read.failures.size(), 2U);
  EXPECT_EQ(read.failures[0].message, "items were lost");
  EXPECT_EQ(read.failures[1].name, "BM_other");
  EXPECT_EQ(read.machine.at("caches"), "L1 Data 32 KiB");
  EXPECT_EQ(read.machine.count("host_name"), 0U);
}

/// Files that break off, at every seventh byte, and others that may be in a folder.
TEST(Report, LeavesOutFilesThatAreNotWhole) {
  const std::string whole = json, unit = R"("time_unit": "us")";
  std::vector<std::string> wrong = {"[1, 2", "[]", "{}", "7",
                                    R"({"benchmarks": [], "contexts": 1})"};
  for (std::size_t size = 0; size < whole.size(); size += 7) wrong.push_back(whole.substr(0, size));
  wrong.push_back(whole);
  wrong.back().replace(whole.find(unit), unit.size(), R"("time_unit": "years")");
  const Folder folder;
  const auto good = folder.write("good.json", json);
  for (const std::string& text : wrong) {
    const auto bad = folder.write("bad.json", text);
    const Samples all = read_samples({bad, good});
    EXPECT_EQ(all.samples.size(), 1U) << text;
    EXPECT_EQ(all.failures.size(), 2U) << text;
    ASSERT_EQ(all.unread.size(), 1U) << text;
    EXPECT_EQ(all.unread[0].name, bad.string());
    EXPECT_FALSE(all.unread[0].message.empty());
    EXPECT_EQ(all.unread[0].message.find('\n'), std::string::npos);
    EXPECT_NE(page(all, hold_contests(all.samples)).text().find("<b>bad.json is left out"),
              std::string::npos);
  }
}

TEST(Report, NamesAFileIfNoneCanBeRead) {
  const Folder folder;
  const auto file = folder.write("all.json", "[1, 2");
  for (const auto& wrong : {file, std::filesystem::path("not_there.json")}) {
    try {
      read_samples({wrong});
      ADD_FAILURE() << wrong;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(wrong.string()), std::string::npos);
    }
  }
}

TEST(Report, ListsTimesThatCannotBe) {
  for (const char* const time : {"0", "-3"}) {
    std::string text = json;
    const std::string measured = "1.5e+02";
    text.replace(text.find(measured), measured.size(), time);
    const Folder folder;
    const auto good = folder.write("good.json", json);
    const Samples all = read_samples({good, folder.write("odd.json", text)});
    EXPECT_EQ(all.samples.size(), 1U) << time;
    EXPECT_EQ(all.failures.size(), 5U) << time;
  }
}

TEST(Report, OrdersByMedianAndSaysWhoIsOnAPar) {
  const Contests held = hold_contests(samples({sample("c.slow", 2, 300), sample("a.fast", 2, 100),
                                               sample("b.near", 2, 101), sample("floor", 2, 50)}));
  ASSERT_EQ(held.contests.size(), 1U);
  const Contest& contest = held.contests.front();
  ASSERT_EQ(contest.figures.size(), 3U);
  EXPECT_EQ(contest.best().candidate, "a.fast");
  EXPECT_DOUBLE_EQ(contest.best().median_ns, 100);
  EXPECT_DOUBLE_EQ(contest.best().low_ns, 99);
  EXPECT_DOUBLE_EQ(contest.best().over_floor.value(), 2);
  EXPECT_TRUE(contest.figures[1].on_par);
  EXPECT_FALSE(contest.clear());
  EXPECT_FALSE(contest.figures[2].on_par);
  EXPECT_DOUBLE_EQ(contest.figures[2].over_best, 3);
}

TEST(Report, SerialCandidatesTakePartAtEveryNumberOfThreads) {
  const Contests held = hold_contests(
      samples({sample("a.serial", 1, 100), sample("b.team", 1, 150), sample("b.team", 2, 110),
               sample("floor", 1, 40), sample("floor", 2, 60)}));
  ASSERT_EQ(held.contests.size(), 2U);
  const Contest& two = held.contests.back();
  EXPECT_EQ(two.threads, 2);
  ASSERT_EQ(two.figures.size(), 2U);
  EXPECT_EQ(two.best().candidate, "a.serial");
  EXPECT_EQ(two.best().threads, 1);
  EXPECT_DOUBLE_EQ(two.floor->median_ns, 40);  // one thread is the faster here
}

TEST(Report, LeavesOutSamplesOfThreadsThatMoved) {
  std::vector<Sample> all = samples({sample("a.x", 2, 100), sample("b.y", 2, 200)});
  all[0].ping_after_ns = 400, all[0].ns = 1;                         // moved meanwhile
  all[1].ping_before_ns = all[1].ping_after_ns = 50, all[1].ns = 1;  // hyperthreads
  all[2].ping_before_ns = 0, all[2].ns = 1;                          // somebody else held a core
  const Contests held = hold_contests(all);
  EXPECT_EQ(held.usual, Distance::near);
  const Figure& x = held.contests.front().best();
  EXPECT_EQ(x.candidate, "a.x");
  EXPECT_EQ(x.samples, 2U);
  EXPECT_EQ(x.left_out, 3U);
  EXPECT_DOUBLE_EQ(x.median_ns, 101.5);
  EXPECT_FALSE(x.mixed);
}

TEST(Report, UsesSamplesAtOtherDistancesIfThereAreNoOthers) {
  std::vector<Sample> all = samples({sample("a.x", 2, 100), sample("b.y", 2, 200)});
  for (std::size_t i = 0; i < 4; ++i) all[i].ping_after_ns = 400;
  all[4].ping_before_ns = all[4].ping_after_ns = 400;
  const Contests held = hold_contests(all);
  const Figure& x = held.contests.front().figures.front();
  EXPECT_TRUE(x.mixed);
  EXPECT_EQ(x.samples, 5U);
}

TEST(Report, WarnsOfFewSamples) {
  const std::string warning = "fewer than three samples";
  Samples all;
  all.samples = samples({sample("a.x", 2, 100), sample("b.y", 2, 200)});
  EXPECT_EQ(page(all, hold_contests(all.samples)).text().find(warning), std::string::npos);
  all.samples = {sample("a.x", 2, 100), sample("b.y", 2, 200)};
  EXPECT_NE(page(all, hold_contests(all.samples)).text().find(warning), std::string::npos);
}

/// Candidates a.x, the fastest, and b.y of three samples each, of which so many count.
std::vector<Sample> three_each(int of_x, int of_y) {
  std::vector<Sample> all;
  for (const auto& [who, ns, count] : {std::tuple("a.x", 100.0, of_x), {"b.y", 200.0, of_y}})
    for (int i = 0; i < 3; ++i) {
      all.push_back(sample(who, 2, ns));
      if (i >= count) all.back().ping_after_ns = 400;  // moved
    }
  for (const double ns : {50.0, 50.0, 50.0}) all.push_back(sample("floor", 2, ns));
  return all;
}

TEST(Report, TooFewSamplesWinNothing) {
  for (int left = 0; left <= 3; ++left)
    for (int other = 0; other <= 3; ++other) {
      Samples all;
      all.samples = three_each(left, other);
      const Contests held = hold_contests(all.samples);
      const bool wins = left == 3;
      EXPECT_EQ(held.contests.front().clear(), wins) << left;
      for (const By by : {By::candidate, By::library}) {
        const auto standing = standings(held.contests, by).front();
        EXPECT_EQ(standing.won.size(), wins ? 1U : 0U) << left;
        EXPECT_EQ(standing.undecided.size(), wins ? 0U : 1U) << left;
      }
      const std::string html = page(all, held).text();
      EXPECT_EQ(html.find("class=\"won\"") != std::string::npos, wins) << left;
      EXPECT_EQ(html.find("class=\"few\"") != std::string::npos, !wins) << left;
      EXPECT_EQ(html.find("Not decided") != std::string::npos, !wins) << left;
    }
  const auto said = sentences(hold_contests(three_each(1, 3)).contests);
  EXPECT_EQ(said[0], "Nobody was fastest beyond the spread of the samples.");
  EXPECT_EQ(said[1],
            "Not decided, because fewer than 3 samples of the one that seems fastest count: "
            "case (a.x, 1 of 3).");
  EXPECT_NE(sentences(hold_contests(three_each(0, 3)).contests)[1].find(
                "case (a.x, none of 3 at the usual distance)."),
            std::string::npos);
}

/// However samples are left out: a candidate that wins alone has three, and no other is on a par.
TEST(Report, WinnersHaveSamplesEnough) {
  std::mt19937 random(38);
  std::uniform_int_distribution<int> percent(0, 99), samples_each(1, 6);
  int decided = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Sample> all;
    for (const char* const who : {"a.x", "a.y", "b.x", "c"})
      for (int i = samples_each(random); i > 0; --i) {
        all.push_back(sample(who, 2, 50 + percent(random)));
        if (percent(random) < 30) all.back().ping_after_ns = 400;
      }
    const Contests held = hold_contests(all);
    const Contest& contest = held.contests.front();
    std::size_t won = 0;
    for (const Standing& standing : standings(held.contests, By::candidate)) {
      won += standing.won.size();
      if (!standing.won.empty()) {
        EXPECT_EQ(standing.who, contest.best().candidate);
      }
    }
    const auto on_par = std::count_if(contest.figures.begin(), contest.figures.end(),
                                      [](const Figure& figure) { return figure.on_par; });
    EXPECT_EQ(won, contest.best().samples >= 3 && !contest.best().mixed && on_par == 1 ? 1U : 0U);
    decided += static_cast<int>(won);
  }
  EXPECT_GT(decided, 20);
}

TEST(Report, SaysWhatIsBelowItsFloor) {
  struct Try {
    double ns, apart;
    bool wrong;
  };
  for (const auto& [ns, apart, wrong] : {Try{80, 0.01, true},
                                         {80, 0.3, false},
                                         {97, 0.01, true},
                                         {99, 0.01, false},
                                         {100, 0, false},
                                         {99.9, 0, true},
                                         {120, 0.01, false},
                                         {0.001, 0.01, true}}) {
    // b.y is never below, and a.x not always the fastest.
    Samples all;
    all.samples =
        samples({sample("a.x", 2, ns), sample("b.y", 2, 105), sample("floor", 2, 100)}, apart);
    const Contests held = hold_contests(all.samples);
    const std::string last = sentences(held.contests).back(), html = page(all, held).text();
    EXPECT_EQ(last.find("so that either the floor or the measurement is wrong: "
                        "case (floor 100 ns): a.x " +
                        time_words(ns) + '.') != std::string::npos,
              wrong)
        << ns << ": " << last;
    EXPECT_EQ(html.find("In 1 of 1 comparisons somebody is below the floor") != std::string::npos,
              wrong)
        << ns;
    EXPECT_EQ(html.find("<td class=\"wrong\">") != std::string::npos, wrong) << ns;
  }
}

TEST(Report, CallsThreePercentAPar) {
  const Contests held =
      hold_contests({sample("a.x", 2, 100), sample("b.y", 2, 102.9), sample("c.z", 2, 103.1)});
  const auto& figures = held.contests.front().figures;
  EXPECT_TRUE(figures[1].on_par);
  EXPECT_FALSE(figures[2].on_par);
}

TEST(Report, SaysInWordsWhoWonWhere) {
  std::vector<Sample> medians = {sample("a.x", 2, 100), sample("b.y", 2, 200),
                                 sample("floor", 2, 50)};
  for (std::size_t i = 0; i < 3; ++i) {
    medians.push_back(medians[i]);
    medians.back().name.case_name = "other";
  }
  medians[3].ns = 800;  // a.x in the other case, where b.y takes 200
  const Contests held = hold_contests(samples(medians));
  const auto said = sentences(held.contests);
  ASSERT_EQ(said.size(), 3U);
  EXPECT_EQ(said[0],
            "Fastest beyond the spread of its samples: b.y in 1 (other); a.x in 1 (case).");
  EXPECT_EQ(said[1],
            "Time over that of the best, geometric mean of the cases: b.y 1.41, a.x 2.00.");
  EXPECT_EQ(said[2], "The fastest took 2.00 to 4.00 times the floor, in the geometric mean 2.83.");
}

TEST(Report, StandingsOfLibrariesTakeTheBestOfEach) {
  const Contests held =
      hold_contests(samples({sample("a.x", 2, 300), sample("a.z", 2, 100), sample("b.y", 2, 200)}));
  const auto all = standings(held.contests, By::library);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].who, "a");
  EXPECT_EQ(all[0].won.size(), 1U);
  EXPECT_DOUBLE_EQ(all[1].over_best, 2);
}

TEST(Report, WritesTimesWithThreeDigits) {
  EXPECT_EQ(time_words(0.5), "0.50 ns");
  EXPECT_EQ(time_words(12.34), "12.3 ns");
  EXPECT_EQ(time_words(999.9), "1.00 us");
  EXPECT_EQ(time_words(1234567), "1.23 ms");
  EXPECT_EQ(time_words(2e9), "2.00 s");
  EXPECT_EQ(ratio_words(12345), "12345");
  EXPECT_EQ(ratio_words(2.5e6), "2.50 million");
  EXPECT_EQ(ratio_words(3e12), "3000 billion");
  EXPECT_EQ(ratio_words(0.87), "0.87");
  EXPECT_EQ(ratio_words(0.000123), "0.00012");
}

TEST(Report, PageShowsEveryCandidateAndEscapesNames) {
  Samples all;
  all.samples = samples({sample("a.x<y", 2, 100), sample("b.y", 2, 200), sample("floor", 2, 50)});
  all.failures = {{"name", "items & more were lost"}};
  const Contests held = hold_contests(all.samples);
  const std::string html = page(all, held).text();
  for (const char* const part :
       {"Which won where", "a.x&lt;y", "<td class=\"won\">a.x&lt;y</td><td>100 ns</td>",
        "src=\"subject_threads_2.svg\"", "near each other", "items &amp; more were lost"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(html.find("x<y"), std::string::npos);
}

}  // namespace
}  // namespace ductile::bench::report
