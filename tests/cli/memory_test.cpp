/// @file
/// The limit on memory counts the program's own memory; a request that exceeds it is refused at
/// once.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <vector>

#include "spawned.hpp"

namespace ductile::cli::memory_test {
namespace {

class Memory : public testing::Test {
 protected:
  Memory() { add_small_meshes(folder_); }

  std::optional<int> adapt(const std::string& words) const {
    return wait_for(spawn(folder_, "adapt " + words + " -o o.mesh --json o.json --threads 1"), 120);
  }

  std::size_t megabytes_told() const {
    const std::string json = folder_.read("o.json"), key = "\"peak_memory_bytes\": ";
    return static_cast<std::size_t>(std::atol(json.c_str() + json.find(key) + key.size())) >> 20U;
  }

  const Folder folder_;
};

TEST_F(Memory, IsTheProgramsOwnWhateverItsParentHolds) {
  const std::vector<char> held(std::size_t{400} << 20U, 'x');
  ASSERT_EQ(adapt("s.mesh -hsiz 0.3 -m 100"), 0) << errors_of(folder_);
  EXPECT_LT(megabytes_told(), 100U);
  EXPECT_GT(megabytes_told(), 1U);
  EXPECT_EQ(held.back(), 'x');
}

TEST_F(Memory, IsRefusedOnlyWhereItIsTooLittle) {
  for (const auto& [words, kind] :
       std::vector<std::pair<std::string, std::string>>{{"s.mesh -hsiz 0.004", "triangles"},
                                                        {"s.mesh -hsiz 0.003", "triangles"},
                                                        {"t.mesh -hsiz 0.035", "tetrahedra"}}) {
    ASSERT_EQ(adapt(words), 0) << errors_of(folder_);
    ASSERT_EQ(adapt(words), 0) << errors_of(folder_);
    const std::size_t taken = megabytes_told();
    std::filesystem::remove(folder_.path() / "o.mesh");
    EXPECT_EQ(adapt(words + " -m " + std::to_string(4 * taken)), 0) << errors_of(folder_);
    std::filesystem::remove(folder_.path() / "o.mesh");
    EXPECT_EQ(adapt(words + " -m " + std::to_string(taken / 2)), 1);
    const std::string said = errors_of(folder_);
    EXPECT_NE(said.find(kind + " on this mesh, which would take about "), std::string::npos)
        << said;
    EXPECT_FALSE(folder_.has("o.mesh"));
  }
}

/// Without -m the machine's memory is the limit.
TEST_F(Memory, IsRefusedBeforeTheWork) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(adapt("t.mesh -hsiz 0.0012"), 1) << errors_of(folder_);
  EXPECT_NE(errors_of(folder_).find("tetrahedra on this mesh"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

}  // namespace
}  // namespace ductile::cli::memory_test
