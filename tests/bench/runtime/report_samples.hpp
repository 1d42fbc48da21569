/// @file
/// Samples and files for the tests of the report.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "samples.hpp"

namespace ductile::bench::report {

/// A folder of the test's own, gone with it.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("report_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
               "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// On two threads near each other, or on one.
inline Sample sample(const std::string& candidate, int threads, double ns) {
  Sample made;
  made.name = {"subject", "case", candidate, threads};
  made.ns = ns;
  if (threads > 1) made.ping_before_ns = made.ping_after_ns = 110;
  return made;
}

/// Five samples of each candidate, 1 % apart.
inline std::vector<Sample> samples(const std::vector<Sample>& medians, double apart = 0.01) {
  std::vector<Sample> all;
  for (const Sample& median : medians)
    for (const int step : {-2, -1, 0, 1, 2}) {
      all.push_back(median);
      all.back().ns *= 1 + step * apart;
    }
  return all;
}

}  // namespace ductile::bench::report
