#include "results.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace ductile::bench {
namespace {

/// Numbers that differ wherever two could be mistaken for each other.
Results results() {
  Sample sample;
  sample.case_name = "x@0.5";
  sample.settings = {.threads = 2, .mode = Mode::colours};
  sample.wall_seconds = 4.5;
  std::iota(sample.part_seconds.begin(), sample.part_seconds.end(), 1.25);
  for (std::size_t k = 0; k < kernel_count; ++k)
    std::iota(sample.phase_seconds[k].begin(), sample.phase_seconds[k].end(),
              100.0 * static_cast<double>(k));
  sample.fingerprint = 0xfedcba9876543210U;  // more than a double holds
  sample.figures = {.share_in_range = 0.75, .mean_quality = 0.5, .least_quality = 0.25};
  sample.before = {60, 300};
  Pair pair{.case_name = "y"};
  pair.mmg.child.status = 139;
  return {{sample}, {{"x@0.5", 2, 1.5}}, {pair}, {"a \"note\""}};
}

TEST(ResultsJson, HoldsAllThatWasMeasured) {
  const auto path = std::filesystem::temp_directory_path() / "ductile_results.json";
  write_json(results(), path);
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file);
  std::filesystem::remove(path);
  const auto& sample = json.at("samples").at(0);
  EXPECT_EQ(sample.at("case"), "x@0.5");
  EXPECT_EQ(sample.at("threads"), 2);
  EXPECT_EQ(sample.at("mode"), "colours");
  EXPECT_EQ(sample.at("fingerprint"), 0xfedcba9876543210U);
  EXPECT_EQ(sample.at("cores_before"), "one core to far");
  EXPECT_EQ(sample.at("cores_after"), "-");
  EXPECT_EQ(sample.at("in_range"), 0.75);
  EXPECT_EQ(sample.at("valid"), false);
  for (std::size_t i = 0; i < part_names.size(); ++i)
    EXPECT_EQ(sample.at("parts").at(part_names[i]), 1.25 + static_cast<double>(i));
  for (std::size_t k = 0; k < kernel_count; ++k)
    for (std::size_t i = 0; i < phase_names.size(); ++i)
      EXPECT_EQ(sample.at("phases").at(part_names[k]).at(phase_names[i]),
                static_cast<double>(100 * k + i));
  EXPECT_EQ(json.at("copies").at(0).at("speed"), 1.5);
  EXPECT_EQ(json.at("pairs").at(0).at("mmg").at("status"), 139);
  EXPECT_EQ(json.at("notes").at(0), "a \"note\"");
}

TEST(ResultsJson, NamesAFileThatCannotBeWritten) {
  try {
    write_json(results(), "/no/such/folder/results.json");
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "/no/such/folder/results.json: cannot be written");
  }
}

}  // namespace
}  // namespace ductile::bench
