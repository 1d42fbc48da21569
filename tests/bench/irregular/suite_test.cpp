/// @file
/// Tests of parts of the benchmark of irregular algorithms: detection of wrong results, options,
/// the results file.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "options.hpp"
#include "peers.hpp"
#include "report.hpp"
#include "suite.hpp"

namespace ductile::bench::irregular {
namespace {

namespace fs = std::filesystem;

/// Doubles a number. `wrong` threads give something else.
Algorithm doubling(int wrong, int wrong_serially = 0) {
  return algorithm(Row<int, int>{
      .name = "doubling",
      .inputs = {"number"},
      .make_input = [](const std::string&, std::size_t size) { return static_cast<int>(size); },
      .begin = [](const int& input) { return input; },
      .serial = [=](const int& input, int& result) { result += input + wrong_serially; },
      .ductile = [=](const runtime::Executor& executor, const int& input,
                     int& result) { result += executor.threads() == wrong ? input + 1 : input; },
      .fault =
          [](const int& input, const int& result, const int& /*serial*/) {
            return unless(result == 2 * input, "does not double");
          }});
}

std::string what_is_wrong(const Algorithm& algorithm, const std::vector<int>& thread_counts) {
  const auto problem = algorithm.problem("number", 21);
  try {
    problem->run_serially();
    for (const int threads : thread_counts)
      problem->run_ductile(runtime::Executor({.threads = threads}));
    problem->run_serially();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(IrregularSuite, FindsWrongResults) {
  EXPECT_EQ(what_is_wrong(doubling(0), {1, 2, 3}), "");
  EXPECT_EQ(what_is_wrong(doubling(1), {1, 2}), "Ductile on 1 threads does not double");
  EXPECT_EQ(what_is_wrong(doubling(2), {1, 2}),
            "Ductile on 2 threads gives another result than before");
  EXPECT_EQ(what_is_wrong(doubling(0, 1), {1}), "the serial code does not double");
}

TEST(IrregularSuite, UnderstandsOptions) {
  const Options usual = options_from({});
  EXPECT_EQ(usual.sizes, (std::vector<std::size_t>{100000, 1000000}));
  EXPECT_EQ(usual.threads, (std::vector<int>{1, 2}));
  const Options options = options_from({"--quick", "--only", "matching", "--size", "50", "--size",
                                        "60", "--threads", "1,4", "--json", "x", "--only", "y"});
  EXPECT_EQ(options.sizes, (std::vector<std::size_t>{50, 60}));
  EXPECT_EQ(options.threads, (std::vector<int>{1, 4}));
  EXPECT_EQ(options.only, (std::vector<std::string>{"matching", "y"}));
  EXPECT_EQ(options.repetitions, 1);
  EXPECT_EQ(options.json, "x");
  const std::vector<std::vector<std::string>> refused{
      {"--size"},         {"--size", "9"},        {"--size", "1e5"},
      {"--size", "-5"},   {"--threads", ""},      {"--threads", "1,,2"},
      {"--threads", "0"}, {"--repetitions", "0"}, {"--size", "99999999999"},
      {"--fast", "1"},    {"size", "100"}};
  for (const auto& words : refused) EXPECT_THROW(options_from(words), UsageError) << words.front();
}

TEST(IrregularSuite, ReplacesItsFileOnlyByAWholeOne) {
  const fs::path folder = fs::path(testing::TempDir()) / "irregular";
  fs::create_directories(folder);
  const fs::path path = folder / "results.json";
  const auto content = [&] {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  };
  JsonFile(path).write({{"a", "b-1", "serial", 1, 2, 2}, {"a", "b-1", "Ductile", 2, 0.5, 2}});
  const std::string whole = content();
  EXPECT_EQ(nlohmann::json::parse(whole),
            nlohmann::json::parse(R"([{"algorithm": "a", "input": "b-1", "threads": 2,
                                       "seconds": 0.5, "serial_seconds": 2}])"));
  { const JsonFile given_up(path); }
  EXPECT_EQ(content(), whole);
  EXPECT_THROW(JsonFile(folder / "nowhere" / "x.json"), std::runtime_error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  fs::remove_all(folder);
}

/// The program prints what a PBBS program does if its arguments are right.
TEST(IrregularSuite, ReadsTheTimesOfOtherPrograms) {
  const fs::path folder = fs::path(testing::TempDir()) / "peers of 'irregular'";
  fs::create_directories(folder);
  std::ofstream(folder / "matching")
      << "#!/bin/sh\n"
         "[ $# = 5 ] && head -n 1 \"$5\" | grep -q EdgeArray || exit 1\n"
         "[ $PARLAY_NUM_THREADS = 2 ] || exit 1\n"
         "for time in 0.3 0.1 0.2; do echo \"Parlay time: $time\"; done\n";
  fs::permissions(folder / "matching", fs::perms::owner_all);
  const std::string before = std::getenv("PATH");
  setenv("PATH", (folder.string() + ':' + before).c_str(), 1);
  const Algorithm graphs = algorithm(Row<GraphInput, int>{
      .name = "matching", .inputs = {"grid"}, .make_input = graph_input, .serial{}, .fault{}});
  const auto problem = graphs.problem("grid", 100);
  const auto times = measure_peers("matching", *problem, {1, 2}, 3);
  EXPECT_TRUE(measure_peers("spanning_tree", *doubling(0).problem("", 1), {1}, 3).empty());
  setenv("PATH", before.c_str(), 1);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].seconds, -1);
  EXPECT_EQ(times[1].seconds, 0.2);
  EXPECT_EQ(times[1].threads, 2);
  fs::remove_all(folder);
}

TEST(IrregularSuite, WritesInputsForOtherPrograms) {
  const GraphInput grid = graph_input("grid", 4);
  const auto text = [&](Format format) {
    std::ostringstream out;
    EXPECT_TRUE(write_input(out, format, grid));
    return out.str();
  };
  EXPECT_EQ(text(Format::adjacency), "AdjacencyGraph\n4\n8\n0\n2\n4\n6\n1\n2\n0\n3\n0\n3\n1\n2\n");
  EXPECT_EQ(text(Format::edges), "EdgeArray\n0 1\n0 2\n1 3\n2 3\n");
  EXPECT_EQ(text(Format::galois).size(), 8 * (4 + 4) + 4 * 8);
  EXPECT_EQ(text(Format::galois_weighted).size(), 8 * (4 + 4) + 4 * 8 + 4 * 8);
  EXPECT_THROW(graph_input("shuffled-tree", 10), std::invalid_argument);
}

}  // namespace
}  // namespace ductile::bench::irregular
