/// @file
/// Kills the program at each step of renaming its outputs, and at random moments: the remaining
/// files belong to one run, and a reader notices if some are missing.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "spawned.hpp"

namespace ductile::cli::killed_test {
namespace {

using Contents = std::map<std::string, std::string>;

/// A folder with the outputs of a first run, which a second run overwrites.
class Killed : public testing::Test {
 protected:
  Killed() {
    add_small_meshes(folder_);
    inputs_ = contents_of(folder_);
    EXPECT_EQ(wait_for(spawn(folder_, command("0.5"))), 0) << errors_of(folder_);
    old_ = contents_of(folder_);
    EXPECT_EQ(wait_for(spawn(folder_, command("0.2"))), 0) << errors_of(folder_);
    new_ = contents_of(folder_);
    EXPECT_EQ(old_.size(), new_.size());
  }

  static std::string command(const std::string& size) {
    return "adapt s.mesh -hsiz " + size + " -o o.mesh --field s.sol --threads 2";
  }

  void put_old_ones_back() const {
    std::filesystem::remove_all(folder_.path());
    std::filesystem::create_directory(folder_.path());
    for (const auto& [name, bytes] : old_) folder_.write(name, bytes);
  }

  /// Expects that all files are old or all are new.
  void expect_a_unit(const std::string& where) const {
    const Contents now = contents_of(folder_);
    EXPECT_TRUE(now == old_ || now == new_) << where << ": " << now.size() << " files";
  }

  /// Expects that all files are of the same run as the mesh, and that `adapt` refuses the mesh if
  /// its metric is missing.
  void expect_no_mixture(const std::string& where) const {
    const Contents now = contents_of(folder_);
    ASSERT_TRUE(now.contains("o.mesh")) << where;
    const Contents& unit = now.at("o.mesh") == old_.at("o.mesh") ? old_ : new_;
    bool complete = true;
    for (const auto& [name, bytes] : unit) {
      complete = complete && now.contains(name);
      EXPECT_TRUE(!now.contains(name) || now.at(name) == bytes) << name << " " << where;
    }
    if (complete || now.contains("o.sol")) return;
    EXPECT_EQ(wait_for(spawn(folder_, "adapt o.mesh -o p.mesh")), 2) << where;
    EXPECT_NE(errors_of(folder_).find("a run that was ended left"), std::string::npos)
        << errors_of(folder_) << where;
  }

  void expect_right_after(int number, const std::string& where) const {
    if (number == SIGKILL)
      expect_no_mixture(where);
    else
      expect_a_unit(where);
  }

  const Folder folder_;
  Contents inputs_, old_, new_;
};

TEST_F(Killed, AtEachStepLeavesFilesOfOneRun) {
  const std::string count_file = folder_.path().string() + ".count";
  Environment steps{{"LD_PRELOAD", DUCTILE_KILLING_STEPS}, {"DUCTILE_KILL_COUNT", count_file}};
  put_old_ones_back();
  ASSERT_EQ(wait_for(spawn(folder_, command("0.2"), steps)), 0);
  const int count = std::stoi(folder_.read(count_file));
  ASSERT_GT(count, 8);
  for (const int number : {SIGKILL, SIGTERM, SIGINT, SIGHUP, SIGQUIT})
    for (int at = 1; at <= count; ++at) {
      const std::string where = "signal " + std::to_string(number) + " at step " +
                                std::to_string(at) + " of " + std::to_string(count);
      put_old_ones_back();
      steps["DUCTILE_KILL_AT"] = std::to_string(at);
      steps["DUCTILE_KILL_WITH"] = std::to_string(number);
      EXPECT_EQ(wait_for(spawn(folder_, command("0.2"), steps)), -number) << where;
      expect_right_after(number, where);
    }
}

TEST_F(Killed, AtRandomMomentsLeavesFilesOfOneRun) {
  std::mt19937 random(1);
  const auto start = std::chrono::steady_clock::now();
  wait_for(spawn(folder_, command("0.2")));
  const auto usual = std::chrono::steady_clock::now() - start;
  for (int i = 0; i < 200; ++i) {
    put_old_ones_back();
    const int number = i % 3 == 0 ? SIGKILL : i % 3 == 1 ? SIGTERM : SIGINT;
    const pid_t child = spawn(folder_, command("0.2"));
    std::this_thread::sleep_for(usual * (random() % 1000) / 1000);
    ::kill(child, number);
    const auto status = wait_for(child);
    EXPECT_TRUE(status == 0 || status == -number) << status.value_or(-999);
    expect_right_after(number, "run " + std::to_string(i));
  }
}

}  // namespace
}  // namespace ductile::cli::killed_test
