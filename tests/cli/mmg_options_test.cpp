#include "mmg_options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "program.hpp"

namespace ductile::cli::mmg_options_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(MmgOptions, AreTakenWithOneWarningAndChangeNothing) {
  const Folder folder;
  folder.add_example("waves2d");
  ASSERT_EQ(folder.run("adapt waves2d.mesh -hmin 0.05 -o plain.mesh").err, "");
  for (const char* words :
       {"-nofem", "-opnbdy", "-nosizreq", "-keep-ref", "-d", "-val", "-default", "-nr", "-octree 8",
        "-rn", "-rn 0", "-isoref 10", "-rmc", "-rmc 1e-3", "-ar 30",
        "-nofem -opnbdy -nosizreq -keep-ref -d -val -default -nr -octree 8 -rn 1 -hgradreq 1.3"}) {
    const Outcome outcome =
        folder.run("adapt waves2d.mesh -hmin 0.05 -o mmg.mesh " + std::string(words));
    EXPECT_EQ(outcome.status, 0) << words << ": " << outcome.err;
    EXPECT_EQ(lines(outcome.err), 1) << words << ": " << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "warning: Mmg's options that need not be given here: -"))
        << outcome.err;
    EXPECT_EQ(folder.read("mmg.mesh"), folder.read("plain.mesh")) << words;
  }
  const Outcome in = folder.run("adapt -in waves2d.mesh -out mmg.mesh -hmin 0.05 -v 0 -nofem");
  EXPECT_EQ(in.status, 0);
  EXPECT_EQ(in.err, "");
  EXPECT_EQ(folder.read("mmg.mesh"), folder.read("plain.mesh"));
}

/// The frozen boundary is far coarser than the metric asks for. -hgradreq spreads its sizes, unless
/// that is turned off.
TEST(MmgOptions, HgradreqTakesSizesFromWhatIsRequired) {
  const Folder folder;
  folder.add_example("waves2d");
  const std::string adapt = "adapt waves2d.mesh -hsiz 0.01 -nosurf --iterations 2 -o ";
  ASSERT_EQ(folder.run(adapt + "plain.mesh").status, 0);
  ASSERT_EQ(folder.run(adapt + "taken.mesh -hgradreq 2.3").err, "");
  EXPECT_LT(folder.read("taken.mesh").size(),
            0.9 * static_cast<double>(folder.read("plain.mesh").size()));
  for (const char* without : {"-hgradreq -1", "-hgradreq 0", "-hgradreq 2.3 -nosizreq"}) {
    ASSERT_EQ(folder.run(adapt + "same.mesh " + without).status, 0);
    EXPECT_EQ(folder.read("same.mesh"), folder.read("plain.mesh")) << without;
  }
  const Outcome wrong = folder.run("adapt waves2d.mesh -hgradreq 0.5");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "option -hgradreq: expected a factor of 1 or more, or -1"))
      << wrong.err;
}

/// Local bounds from a file, beside the mesh or given, replace the global ones on boundaries and
/// regions.
TEST(MmgOptions, LocalParametersBoundSizesByReference) {
  const Folder folder;
  folder.add_example("waves2d");
  const auto size = [&](const std::string& words) {
    const Outcome outcome =
        folder.run("adapt waves2d.mesh -hsiz 0.1 -o o.mesh --iterations 3 " + words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return std::pair(folder.read("o.mesh").size(), outcome.err);
  };
  const auto [plain, nothing] = size("");
  EXPECT_EQ(nothing, "");
  folder.write("given.mmg2d", "Parameters\n1\n1 Edges 0.004 0.005 0\n");
  for (const char* words : {"-f given.mmg2d", "-f given.mesh -hmin 0.05", "-f given"}) {
    const auto [finer, said] = size(words);
    EXPECT_GT(finer, 2 * plain) << words;
    EXPECT_EQ(said, "");
  }
  folder.write("DEFAULT.mmg2d", "parameters 1 1 Triangle 0.2 0.3 0.01 # all");
  const auto [coarser, said] = size("-hmax 0.15");
  EXPECT_LT(coarser, plain / 2);
  EXPECT_TRUE(contains(said, "DEFAULT.mmg2d: local parameters found; they bound sizes")) << said;
  EXPECT_TRUE(contains(said, "DEFAULT.mmg2d: left out hausd")) << said;
  folder.write("waves2d.mmg2d", "parameters 1 77 Triangle 0.2 0.3 0");
  const auto [same, why] = size("");
  EXPECT_EQ(same, plain);
  EXPECT_TRUE(contains(why, "nothing in the mesh has the references 77")) << why;
  const Outcome wrong = folder.run("adapt waves2d.mesh -f none.mmg2d -o o.mesh");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "none.mmg2d: cannot read")) << wrong.err;
  folder.write("given.mmg2d", "Parameters 1 1 Tetrahedra 1 1 0");
  EXPECT_TRUE(contains(folder.run("adapt waves2d.mesh -f given.mmg2d").err, "found tetrahedra"));
}

/// A number after -rn is its argument, the name of a mesh is not.
TEST(MmgOptions, LeaveTheMeshWhereANumberMayBeMissing) {
  const Folder folder;
  folder.add_example("waves2d");
  EXPECT_EQ(folder.run("adapt -rn waves2d.mesh -noinsert -nomove -noswap -o o.mesh").status, 0);
  EXPECT_EQ(folder.run("adapt -rn 1 waves2d.mesh -noinsert -nomove -noswap -o o.mesh").status, 0);
}

/// The sizes of the mesh count even if a metric lies beside it.
TEST(MmgOptions, OptimKeepsTheSizesThatTheMeshHas) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome outcome = folder.run("adapt waves2d.mesh -optim -o optim.mesh");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "adapting to the sizes that the mesh has")) << outcome.err;
  std::filesystem::rename(folder.path() / "waves2d.sol", folder.path() / "away.sol");
  ASSERT_EQ(folder.run("adapt waves2d.mesh -o plain.mesh").status, 0);
  EXPECT_EQ(folder.read("optim.mesh"), folder.read("plain.mesh"));
}

TEST(MmgOptions, AreNotShownInHelp) {
  const Folder folder;
  const Outcome help = folder.run("help adapt");
  EXPECT_EQ(help.status, 0);
  EXPECT_FALSE(contains(help.out, "-nofem"));
}

}  // namespace
}  // namespace ductile::cli::mmg_options_test
