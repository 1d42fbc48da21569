#include "plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "cases/adapt_case.hpp"

namespace ductile::bench {
namespace {

Plan plan(const std::vector<std::string>& words) {
  return plan_from(cli::Arguments(plan_options(), words));
}

TEST(Plan, TakesTheCasesThatAreNamed) {
  const Plan taken = plan({"--cases", "psi2d,uni3d@2", "--scale", "0.5", "--threads", "6"});
  EXPECT_EQ(taken.cases, (std::vector<std::string>{"psi2d@0.5", "uni3d@1"}));
  EXPECT_EQ(taken.most_threads, 6);
}

TEST(Plan, DoublesThreadsUpToTheMost) {
  const auto settings = settings_for(plan({"--threads", "6"}), "psi2d");
  std::vector<int> tiles, colours;
  for (const RunSettings& one : settings)
    (one.mode == Mode::tiles ? tiles : colours).push_back(one.threads);
  EXPECT_EQ(tiles, (std::vector<int>{1, 2, 4, 6}));
  EXPECT_EQ(colours, (std::vector<int>{1, 6}));
}

TEST(Plan, RunsLargeCasesOnAllThreadsOnly) {
  const auto settings = settings_for(plan({"--threads", "4"}), "psi2d@10");
  ASSERT_EQ(settings.size(), 1U);
  EXPECT_EQ(settings[0].threads, 4);
  EXPECT_FALSE(is_large("psi2d"));
  EXPECT_FALSE(is_large("psi2d@0.1"));
}

TEST(Plan, KnowsEveryCaseThatItMeasures) {
  for (const Plan& one : {plan({}), plan({"--quick"})})
    for (const std::string& name : one.cases) {
      const std::string base = name.substr(0, name.find('@'));
      EXPECT_TRUE(std::any_of(known_cases().begin(), known_cases().end(),
                              [&](const CaseInfo& info) { return info.name == base; }))
          << name;
    }
}

TEST(Plan, RefusesWhatIsNoOption) {
  EXPECT_THROW(plan({"psi2d"}), cli::UsageError);
  EXPECT_THROW(plan({"--repetitions", "0"}), cli::UsageError);
}

}  // namespace
}  // namespace ductile::bench
