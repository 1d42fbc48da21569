#include "arguments.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace ductile::cli::arguments_test {
namespace {

constexpr std::array<Option, 4> options{{{"-hmin", "X", ""},
                                         {"--threads", "N", ""},
                                         {"-o", "FILE", "", "--output"},
                                         {"-nomove", "", ""}}};

Arguments parse(std::vector<std::string> words) { return Arguments(options, words); }

TEST(Arguments, TakesMmgsAndGnusForms) {
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"a.mesh", "-hmin", "0.5"}, {"--hmin", "0.5", "a.mesh"}, {"-hmin=5e-1", "a.mesh"}}) {
    const Arguments arguments = parse(words);
    EXPECT_EQ(arguments.positive("-hmin"), 0.5);
    EXPECT_EQ(arguments.operands(), std::vector<std::string>{"a.mesh"});
  }
  EXPECT_EQ(parse({"--output", "x"}).text("-o"), "x");
  EXPECT_EQ(parse({"-threads", "3"}).integer("--threads", 1, 8), 3);
}

TEST(Arguments, TakesNegativeNumbersAndDashesForWhatTheyAre) {
  EXPECT_EQ(parse({"-hmin", "-1"}).number("-hmin"), -1.0);
  EXPECT_EQ(parse({"--", "-nomove"}).operands(), std::vector<std::string>{"-nomove"});
  EXPECT_EQ(parse({"-"}).operands(), std::vector<std::string>{"-"});
}

TEST(Arguments, TheLastOneCounts) {
  EXPECT_EQ(parse({"-hmin", "1", "-hmin", "2"}).number("-hmin"), 2.0);
}

TEST(Arguments, TellsWhatIsMissingOrUnknown) {
  EXPECT_FALSE(parse({}).has("-nomove"));
  EXPECT_EQ(parse({}).number("-hmin"), std::nullopt);
  EXPECT_THROW(parse({"-hmin"}), UsageError);
  EXPECT_THROW(parse({"-hmin", "-nomove"}), UsageError);
  EXPECT_THROW(parse({"-hmin="}), UsageError);
  EXPECT_THROW(parse({"-unknown"}), UsageError);
  EXPECT_THROW(parse({"-nomove=1"}), UsageError);
}

/// Whatever letters of a name are mixed up, except that the name of another option is that option.
TEST(Arguments, KnowsTheLettersOfAName) {
  constexpr std::array<Option, 3> names{
      {{"-hsiz", "X", "size"}, {"-rmc", "X", "components"}, {"--iterations", "N", "rounds"}}};
  for (const Option& option : names)
    for (std::size_t i = option.name.find_first_not_of('-'); i < option.name.size(); ++i)
      for (std::size_t j = i + 1; j < option.name.size(); ++j) {
        std::string word(option.name);
        std::swap(word[i], word[j]);
        if (word == option.name) continue;
        try {
          const Arguments accepted(names, std::vector<std::string>{word, "1"});
          ADD_FAILURE() << word;
        } catch (const UnknownOption& error) {
          EXPECT_TRUE(
              std::string(error.what()).ends_with("did you mean " + std::string(option.name) + "?"))
              << error.what();
        }
      }
}

TEST(Arguments, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "x", "1x", "inf", "nan", "1e999", "0x1", " 1"})
    EXPECT_THROW(parse({std::string("-hmin=") + text}).number("-hmin"), UsageError) << text;
  for (const char* text : {"0", "9", "1.5", "99999999999"})
    EXPECT_THROW(parse({"--threads", text}).integer("--threads", 1, 8), UsageError) << text;
}

TEST(EditDistance, CountsTypingErrors) {
  EXPECT_EQ(edit_distance("adapt", "adapt"), 0U);
  EXPECT_EQ(edit_distance("adpat", "adapt"), 1U);
  EXPECT_EQ(edit_distance("hmn", "hmin"), 1U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
}

}  // namespace
}  // namespace ductile::cli::arguments_test
