#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "contests.hpp"
#include "page.hpp"
#include "plot.hpp"
#include "samples.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

/// A file in a folder of the test's own, gone with it.
class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("report_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
               "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

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

/// On two threads near each other, or on one.
Sample sample(const std::string& candidate, int threads, double ns) {
  Sample made;
  made.name = {"subject", "case", candidate, threads};
  made.ns = ns;
  if (threads > 1) made.ping_before_ns = made.ping_after_ns = 110;
  return made;
}

/// Five samples of each candidate, 1 % apart.
std::vector<Sample> samples(const std::vector<Sample>& medians) {
  std::vector<Sample> all;
  for (const Sample& median : medians)
    for (const double factor : {0.98, 0.99, 1.0, 1.01, 1.02}) {
      all.push_back(median);
      all.back().ns *= factor;
    }
  return all;
}

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
  const File file(json);
  const Samples read = read_samples({file.path()});
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

TEST(Report, NamesTheFileThatIsNoJson) {
  const File file("[1, 2");
  try {
    read_samples({file.path()});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(file.path().string()), std::string::npos);
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
  const Figure& x = hold_contests(all).contests.front().figures.front();
  EXPECT_TRUE(x.mixed);
  EXPECT_EQ(x.samples, 5U);
}

TEST(Report, WarnsOfFewSamples) {
  const std::string warning = "fewer than three samples";
  Samples all;
  all.samples = samples({sample("a.x", 2, 100), sample("b.y", 2, 200)});
  EXPECT_EQ(page(all, hold_contests(all.samples)).find(warning), std::string::npos);
  all.samples = {sample("a.x", 2, 100), sample("b.y", 2, 200)};
  EXPECT_NE(page(all, hold_contests(all.samples)).find(warning), std::string::npos);
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
}

TEST(Report, PageShowsEveryCandidateAndEscapesNames) {
  Samples all;
  all.samples = samples({sample("a.x<y", 2, 100), sample("b.y", 2, 200), sample("floor", 2, 50)});
  all.failures = {{"name", "items & more were lost"}};
  const Contests held = hold_contests(all.samples);
  const std::string html = page(all, held);
  for (const char* const part :
       {"Which won where", "a.x&lt;y", "<td class=\"won\">a.x&lt;y</td><td>100 ns</td>",
        "src=\"subject_threads_2.svg\"", "near each other", "items &amp; more were lost"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(html.find("x<y"), std::string::npos);
}

/// Of a mark's title, the horizontal place of the mark.
double place_of_mark(const std::string& svg, const std::string& title) {
  const std::size_t end = svg.find("<title>" + title);
  const std::string key = "translate(";
  const std::size_t begin = svg.rfind(key, end) + key.size();
  return end == std::string::npos ? -1 : std::stod(svg.substr(begin));
}

TEST(Report, PlotPutsRatiosOnALogarithmicAxis) {
  const Contests held = hold_contests(samples({sample("a.x", 2, 100), sample("b.y", 2, 200),
                                               sample("c.z", 2, 400), sample("floor", 2, 50)}));
  const std::string svg = plot(held.contests, held.contests);
  const double x = place_of_mark(svg, "a.x 100 ns"), y = place_of_mark(svg, "b.y 200 ns");
  EXPECT_GT(x, 0);
  EXPECT_GT(y, x);
  EXPECT_NEAR(place_of_mark(svg, "c.z 400 ns") - y, y - x, 0.1);
}

}  // namespace
}  // namespace ductile::bench::report
