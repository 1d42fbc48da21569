// Files, child processes, cases and trials of the campaign: wrong programs are detected, and the
// generators make sound cases.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "build.hpp"
#include "case.hpp"
#include "child.hpp"
#include "mesh_file.hpp"
#include "trial.hpp"

namespace ductile::campaign {
namespace {

namespace fs = std::filesystem;

class CampaignTrial : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("campaign-test-" + std::to_string(getpid()) + "-" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  /// The verdict on a program that consists of this script; $2 is the input, $4 the output.
  Outcome try_script(const std::string& script, const Case& tried) const {
    write("program", "#!/bin/sh\n" + script);
    fs::permissions(folder_ / "program", fs::perms::owner_all);
    return try_case(
        tried, 1, folder_ / "case",
        {.program = folder_ / "program", .limit_s = 0.5, .level_sets = false, .all_checks = true});
  }

  /// A case for which a copy of the input is a right answer.
  static Case copied_case() {
    Case tried = make_case(5, 0, "few-digits");
    tried.unrounded.reset();
    tried.metric.reset();
    tried.options.clear();
    tried.promise = {};
    tried.rests = tried.deterministic = true;
    return tried;
  }

  fs::path folder_;
};

const char* const copies = "[ \"$1\" = adapt ] || exit 0\ncp \"$2\" \"$4\"\n";

// ---- Files ----

TEST_F(CampaignTrial, MeshesComeBackAsTheyWereWritten) {
  Case tried = make_case(3, 12, "required");
  write_mesh(folder_ / "a.mesh", tried.mesh);
  write_mesh(folder_ / "b.mesh", read_mesh(folder_ / "a.mesh"));
  std::ifstream a(folder_ / "a.mesh"), b(folder_ / "b.mesh");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(a), {}),
            std::string(std::istreambuf_iterator<char>(b), {}));
}

TEST_F(CampaignTrial, FilesThatAreNoneAreRefused) {
  const std::string begin = "MeshVersionFormatted 2\nDimension 2\n";
  for (const char* text : {"", "MeshVersionFormatted 2\nDimension 4\nEnd", "x",
                           "MeshVersionFormatted 2\nDimension 2\nVertices 2\n0 0 0\n0 0",
                           "MeshVersionFormatted 2\nDimension 2\nVertices 1\n0 0z 0\nEnd",
                           "MeshVersionFormatted 2\nDimension 2\nNonsense 0\nEnd",
                           "MeshVersionFormatted 2\nDimension 2\nVertices -1\nEnd"}) {
    write("bad.mesh", text);
    EXPECT_THROW(read_mesh(folder_ / "bad.mesh"), BadFile) << text;
  }
  write("good.mesh", begin + "Vertices 1 0.5 0.25 7 End");
  EXPECT_EQ(read_mesh(folder_ / "good.mesh").point_reference[0], 7);
}

// ---- Child processes ----

TEST_F(CampaignTrial, ChildrenEndAsTheyDo) {
  const auto how = [&](const std::string& script) {
    return run({"/bin/sh", "-c", script}, folder_, 0.5);
  };
  EXPECT_EQ(how("exit 2").status, 2);
  EXPECT_EQ(how("exit 2").how, Ending::How::exited);
  EXPECT_EQ(how("echo words >&2; exit 1").message, "words\n");
  EXPECT_EQ(how("kill -SEGV $$").how, Ending::How::crashed);
  EXPECT_EQ(how("exit 77").how, Ending::How::crashed);
  EXPECT_EQ(how("sleep 20").how, Ending::How::timed_out);
  EXPECT_EQ(how("while :; do :; done").how, Ending::How::timed_out);
  EXPECT_EQ(how("exec 2>&-; sleep 20 & exit 0").how, Ending::How::exited);
}

// ---- Trials ----

TEST_F(CampaignTrial, ARightProgramIsRight) {
  const Outcome outcome = try_script(copies, copied_case());
  EXPECT_EQ(outcome.verdict, Verdict::right) << (outcome.faults.empty() ? "" : outcome.faults[0]);
  EXPECT_TRUE(outcome.closed && outcome.rested);
}

TEST_F(CampaignTrial, WrongProgramsAreFoundOut) {
  const Case tried = copied_case();
  const auto verdict = [&](const std::string& script) { return try_script(script, tried).verdict; };
  EXPECT_EQ(verdict("exit 1"), Verdict::wrong);
  EXPECT_EQ(verdict("exit 0"), Verdict::wrong);  // nothing written
  EXPECT_EQ(verdict("kill -SEGV $$"), Verdict::crash);
  EXPECT_EQ(verdict("sleep 20"), Verdict::timeout);
  EXPECT_EQ(verdict(std::string(copies) + "[ \"$6\" = 2 ] && echo >> \"$4\"; exit 0"),
            Verdict::wrong);  // not the same on two threads
  EXPECT_EQ(verdict("[ \"$1\" = info ] && exit 2\n" + std::string(copies)), Verdict::wrong);
  EXPECT_EQ(verdict("[ \"$2\" = out.mesh ] && exit 1\n" + std::string(copies)), Verdict::wrong);
}

TEST_F(CampaignTrial, RefusalsAreOfTheKindDeclared) {
  Case tried = copied_case();
  const std::string script = "echo 'ductile: -hmin 1 is too small' >&2; exit 2";
  EXPECT_EQ(try_script(script, tried).verdict, Verdict::wrong);
  tried.refusals = {"hmin"};
  EXPECT_EQ(try_script(script, tried).verdict, Verdict::refused);
  tried.refusals = {"hmax"};
  EXPECT_EQ(try_script(script, tried).verdict, Verdict::wrong);
}

TEST_F(CampaignTrial, RestlessProgramsAreNotAtRest) {
  // The second and third call return another mesh of the same domain than their input.
  const Case tried = copied_case();
  Mesh other = tried.mesh;
  Random random(1);
  jitter(random, other, {0.05});
  write_mesh(folder_ / "other.mesh", other);
  const Outcome outcome = try_script(
      std::string(copies) + "[ \"$4\" = out3.mesh ] && cp ../other.mesh out3.mesh; exit 0", tried);
  EXPECT_EQ(outcome.verdict, Verdict::right) << (outcome.faults.empty() ? "" : outcome.faults[0]);
  EXPECT_TRUE(outcome.closed);
  EXPECT_FALSE(outcome.rested);
}

// ---- Cases ----

TEST_F(CampaignTrial, CasesAreSoundAndTheSameEachTime) {
  for (const std::string& kind : kind_names())
    for (std::uint64_t number = 0; number < 12; ++number) {
      SCOPED_TRACE(kind + " " + std::to_string(number));
      const Case tried = make_case(11, number, kind);
      EXPECT_EQ(check_structure(tried.mesh, tried.promise.unlisted_boundary), Faults{});
      EXPECT_EQ(check_surface(tried.mesh, tried.mesh, tried.promise), Faults{});
      EXPECT_EQ(check_overlaps(tried.mesh), Faults{});
      EXPECT_EQ(tried.metric ? tried.metric->size() : tried.mesh.points.size(),
                tried.mesh.points.size());
      const Case again = make_case(11, number, kind);
      EXPECT_EQ(again.mesh.points, tried.mesh.points);
      EXPECT_EQ(again.options, tried.options);
    }
}

}  // namespace
}  // namespace ductile::campaign
