/// @file
/// Fails the program's requests for memory as curl's tests do: each one alone, and all from each
/// one on. With DUCTILE_EVERY_ALLOCATION in the environment, all requests; otherwise a sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "spawned.hpp"

namespace ductile::cli::out_of_memory_test {
namespace {

struct Case {
  const char* name;
  const char* words;
  /// The drawing library may lose a letter without reporting it.
  bool may_differ = false;
};

// GoogleTest asks for a function of this name.
void PrintTo(const Case& c, std::ostream* out) {  // NOLINT(readability-identifier-naming): its name
  *out << c.words;
}

class OutOfMemory : public testing::TestWithParam<Case> {
 protected:
  using Contents = std::map<std::string, std::string>;

  OutOfMemory() { add_small_meshes(folder_); }

  std::optional<int> run(const char* how, long at) const {
    const Environment failing{{"LD_PRELOAD", DUCTILE_FAILING_MEMORY},
                              {"DUCTILE_FAIL", how},
                              {"DUCTILE_FAIL_AT", std::to_string(at)},
                              {"DUCTILE_FAIL_COUNT", count_file()}};
    return wait_for(spawn(folder_, GetParam().words, failing));
  }

  std::string count_file() const { return folder_.path().string() + ".count"; }

  void remove_outputs(const Contents& inputs) const {
    for (const auto& [name, bytes] : contents_of(folder_))
      if (!inputs.contains(name)) std::filesystem::remove(folder_.path() / name);
  }

  /// The numbers of all requests, or of a sample of 40.
  static std::vector<long> chosen(long count) {
    constexpr std::size_t many = 40;
    std::vector<long> numbers(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<long>(i) + 1;
    if (std::getenv("DUCTILE_EVERY_ALLOCATION") != nullptr || numbers.size() <= many)
      return numbers;
    std::shuffle(numbers.begin() + 1, numbers.end(), std::mt19937(1));
    numbers.resize(many);
    return numbers;
  }

  void expect_right(const Contents& right, const char* how, long at) const {
    const std::string where = std::string(" when request ") + std::to_string(at) + " fails " + how;
    for (const auto& [name, bytes] : contents_of(folder_)) {
      ASSERT_TRUE(right.contains(name)) << name << where;
      const bool tells_times = name.ends_with(".json") || GetParam().may_differ;
      EXPECT_TRUE(tells_times || bytes == right.at(name)) << name << where;
    }
    EXPECT_EQ(contents_of(folder_).size(), right.size()) << where;
  }

  const Folder folder_;
};

TEST_P(OutOfMemory, EndsWithALineOrTheRightOutput) {
  const Contents inputs = contents_of(folder_);
  ASSERT_EQ(run("once", 0), 0) << errors_of(folder_);
  const Contents right = contents_of(folder_);
  const long count = std::atol(folder_.read(count_file()).c_str());
  ASSERT_GT(count, 20) << "no request was counted";
  long refused = 0;
  for (const char* how : {"once", "on"})
    for (const long at : chosen(count)) {
      remove_outputs(inputs);
      const std::optional<int> status = run(how, at);
      const std::string said = errors_of(folder_);
      ASSERT_TRUE(status == 0 || status == 1) << "status " << status.value_or(-999)
                                              << " when request " << at << " fails " << how << "\n"
                                              << said;
      if (status == 0) {
        expect_right(right, how, at);
        continue;
      }
      ++refused;
      expect_right(inputs, how, at);
      const std::string libgomp = "\nlibgomp: ";  // it begins with an empty line
      EXPECT_TRUE(tells_one_error(said) || said.starts_with(libgomp)) << said;
    }
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Commands, OutOfMemory,
    testing::Values(
        Case{"adapt",
             "adapt s.mesh -sol s.sol --field s.sol --vtu o.vtu --json o.json --threads 1"},
        Case{"adapt_in_3d", "adapt t.mesh -hsiz 0.7 -hausd 0.01 -hgrad 1.5 --threads 1"},
        Case{"adapt_along_a_level_set",
             "adapt s.mesh -ls 0.5 -sol s.sol -hsiz 0.5 -hausd 0.1 -v 0 --threads 1"},
        Case{"adapt_on_two_threads", "adapt s.mesh -hsiz 0.3 --threads 2"},
        Case{"metric", "metric make s.mesh s.sol --complexity 30 -o o.sol --threads 1"},
        Case{"info", "info s.mesh -sol s.sol --json o.json --threads 1"},
        Case{"convert", "convert s.mesh o.vtu -sol s.sol"},
        Case{"transfer", "transfer s.mesh s.sol s.mesh -o o.vtu --threads 1"},
        Case{"convert_to_binary", "convert s.mesh o.meshb"},
        Case{"view", "view s.mesh -o o.png --size 60 --threads 1", true},
        Case{"view_as_svg", "view t.mesh -o o.svg --size 60 --threads 1", true},
        Case{"help", "help adapt"}),
    [](const testing::TestParamInfo<Case>& named) { return std::string(named.param.name); });

}  // namespace
}  // namespace ductile::cli::out_of_memory_test
