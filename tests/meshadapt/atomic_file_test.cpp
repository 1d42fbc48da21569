#include "io/sink.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

#include "io_support.hpp"

namespace ductile::meshadapt::atomic_file_test {
namespace {

namespace fs = std::filesystem;

TEST(AtomicOutputs, AppearTogether) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a", "old");
  AtomicOutputs outputs;
  outputs.stage(folder / "a").write("new");
  const std::string large(3 * Sink::buffer_size + 7, 'x');
  outputs.stage(folder / "b").write(large);
  EXPECT_EQ(test::get_bytes(folder / "a"), "old");
  EXPECT_FALSE(fs::exists(folder / "b"));
  outputs.commit();
  EXPECT_EQ(test::get_bytes(folder / "a"), "new");
  EXPECT_EQ(test::get_bytes(folder / "b"), large);
  EXPECT_EQ(folder.file_count(), 2U);
}

TEST(AtomicOutputs, LeaveNothingWithoutCommit) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a", "old");
  {
    AtomicOutputs outputs;
    outputs.stage(folder / "a").write("new");
    outputs.stage(folder / "b").write("new");
  }
  EXPECT_EQ(test::get_bytes(folder / "a"), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AtomicOutputs, KeepLinksAndPermissions) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a", "old");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a", folder / "link");
  AtomicOutputs outputs;
  outputs.stage(folder / "link").write("new");
  outputs.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(test::get_bytes(folder / "a"), "new");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicOutputs, WriteToThePipeOfADescriptor) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const fs::path path = "/dev/fd/" + std::to_string(ends[1]);
  EXPECT_NO_THROW(check_writable(path));
  AtomicOutputs outputs;
  outputs.stage(path).write("text");
  outputs.commit();
  std::array<char, 8> text{};
  EXPECT_EQ(::read(ends[0], text.data(), text.size()), 4);
  EXPECT_STREQ(text.data(), "text");
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(AtomicOutputs, WriteOnInTheFileOfADescriptor) {
  const test::TemporaryFolder folder;
  const int descriptor = ::open((folder / "a").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  ASSERT_GE(descriptor, 0);
  const std::string number = std::to_string(descriptor);
  EXPECT_EQ(::write(descriptor, "before ", 7), 7);
  fs::create_symlink("/proc/self/fd/" + number, folder / "link");
  for (const fs::path& path :
       {fs::path("/dev/fd/" + number), fs::path("/proc/self/fd/" + number), folder / "link"}) {
    EXPECT_NO_THROW(check_writable(path));
    AtomicOutputs outputs;
    outputs.stage(path).write("text ");
    outputs.commit();
  }
  EXPECT_EQ(::write(descriptor, "after", 5), 5);
  ::close(descriptor);
  EXPECT_EQ(test::get_bytes(folder / "a"), "before text text text after");
  EXPECT_EQ(folder.file_count(), 2U);
}

TEST(AtomicOutputs, RefuseADescriptorThatIsRead) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a", "old");
  const int descriptor = ::open((folder / "a").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(descriptor, 0);
  const fs::path path = "/dev/fd/" + std::to_string(descriptor);
  EXPECT_NE(test::complaint([&] { check_writable(path); }).find("for reading only"),
            std::string::npos);
  ::close(descriptor);
  EXPECT_THROW(check_writable(path), InputError);
  EXPECT_EQ(test::get_bytes(folder / "a"), "old");
}

TEST(AtomicOutputs, TakeAnyLengthOfName) {
  const test::TemporaryFolder folder;
  const std::string name(255, 'n');
  AtomicOutputs outputs;
  outputs.stage(folder / name).write("x");
  outputs.commit();
  EXPECT_EQ(test::get_bytes(folder / name), "x");
}

TEST(AtomicOutputs, RefusePlacesThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const auto complaint = [](const fs::path& path) {
    std::string at_stage = test::complaint([&] { AtomicOutputs().stage(path); });
    EXPECT_EQ(test::complaint([&] { check_writable(path); }), at_stage);
    return at_stage;
  };
  EXPECT_NE(complaint(folder / "none" / "a").find("there is no folder"), std::string::npos);
  EXPECT_NE(complaint(folder / "").find("found a folder"), std::string::npos);
  EXPECT_NE(complaint("").find("empty"), std::string::npos);
  EXPECT_NE(complaint("/proc/a.mesh").find("/proc/a.mesh: cannot create"), std::string::npos);
  AtomicOutputs outputs;
  outputs.stage(folder / "a");
  fs::create_symlink(folder / "a", folder / "link");
  fs::create_directory(folder / "deep");
  fs::create_directory_symlink(folder / "", folder / "deep" / "up");
  for (const fs::path& again : {folder / "a", folder / "." / "a", folder / "link",
                                folder / "deep" / "up" / "a", folder / "deep" / ".." / "a"}) {
    EXPECT_NE(test::complaint([&] { outputs.stage(again); }).find("two outputs"),
              std::string::npos);
    EXPECT_NE(test::complaint([&] {
                check_writable({folder / "a", folder / "b", again});
              }).find(again.string() + ": is the name of two outputs"),
              std::string::npos);
  }
  EXPECT_NO_THROW(check_writable({folder / "a", folder / "b", "/dev/null"}));
}

TEST(AtomicOutputs, RefuseNamesThatLeadNowhere) {
  const test::TemporaryFolder folder;
  const auto complaint = [](const fs::path& path) {
    std::string at_stage = test::complaint([&] { AtomicOutputs().stage(path); });
    EXPECT_EQ(test::complaint([&] { check_writable(path); }), at_stage);
    return at_stage;
  };
  fs::create_symlink("self", folder / "self");
  fs::create_symlink("b", folder / "a");
  fs::create_symlink(folder / "a", folder / "b");
  for (const fs::path& path : {folder / "self", folder / "a", folder / "b", folder / "a" / "c"})
    EXPECT_NE(complaint(path).find(path.string() + ": cannot write, the name is a link that leads"),
              std::string::npos);
  fs::create_symlink(std::string(300, 'n'), folder / "long");
  fs::path deep = folder / "deep";
  while (deep.string().size() < 5000) deep /= std::string(200, 'd');
  for (const fs::path& path : {folder / std::string(256, 'n'), folder / "long", deep})
    EXPECT_NE(complaint(path).find("longer than the system takes"), std::string::npos);
  fs::create_symlink("none", folder / "dangling");
  EXPECT_NO_THROW(check_writable(folder / "dangling"));
  EXPECT_NO_THROW(check_writable(folder / std::string(255, 'n')));
}

/// The folder is sticky, as /tmp is, and has a file of another user.
TEST(AtomicOutputs, RefuseToReplaceWhatOnlyItsOwnerMay) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can act as two users";
  const test::TemporaryFolder folder;
  fs::permissions(folder / "", fs::perms::all | fs::perms::sticky_bit);
  test::put_bytes(folder / "a", "old");
  fs::permissions(folder / "a", fs::perms::all);
  const pid_t child = fork();
  if (child == 0) {
    if (setuid(65534) != 0) _exit(2);
    const std::string text = test::complaint([&] { check_writable(folder / "a"); });
    check_writable(folder / "b");
    _exit(text.find("only its owner may replace it") == std::string::npos ? 1 : 0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_NO_THROW(check_writable(folder / "a"));
}

/// The system resolves ".." from the target of a link.
TEST(AtomicOutputs, GoUpFromWhereALinkLeads) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "deep" / "down");
  fs::create_directory_symlink(folder / "deep" / "down", folder / "link");
  AtomicOutputs outputs;
  outputs.stage(folder / "link" / ".." / "a").write("x");
  outputs.commit();
  EXPECT_EQ(test::get_bytes(folder / "deep" / "a"), "x");
}

TEST(AtomicOutputs, RefuseAFolderWithoutPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "shut");
  fs::permissions(folder / "shut", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(check_writable(folder / "shut" / "a"), InputError);
}

TEST(AtomicOutputs, CheckingLeavesNoTrace) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a", "old");
  check_writable(folder / "a");
  check_writable(folder / "b");
  EXPECT_EQ(test::get_bytes(folder / "a"), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AtomicOutputs, ReportAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const AnyMesh mesh = test::random_mesh(2, 100, 1);
  try {
    write_mesh("/dev/full", mesh, {.form = WriteOptions::Form::ascii});
    FAIL() << "expected an exception";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full: cannot write, No space left"),
              std::string::npos)
        << error.what();
  }
  write_mesh("/dev/null", mesh, {.form = WriteOptions::Form::ascii});
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
}

/// Limits the size of files to `bytes` during its lifetime; exceeding it ends the process.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &previous_);
    const rlimit limit{bytes, previous_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &previous_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit previous_{};
};

TEST(AtomicOutputs, KeepTheOldFileWhenTheNewOneMayNotGrow) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a.meshb", "old");
  const AnyMesh mesh = test::random_mesh(3, 50000, 1);
  for (const rlim_t limit : {0, 1, 300000, 1000000}) {
    const FileSizeLimit limited(limit);
    EXPECT_THROW(write_mesh(folder / "a.meshb", mesh), Error);
    EXPECT_THROW(write_mesh(folder / "b.mesh", mesh), Error);
  }
  EXPECT_EQ(test::get_bytes(folder / "a.meshb"), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AtomicOutputs, NeverCommitAFileWithAGap) {
  const test::TemporaryFolder folder;
  AtomicOutputs outputs;
  Sink& file = outputs.stage(folder / "a");
  {
    const FileSizeLimit limited(1);
    EXPECT_THROW(file.write(std::string(2 * Sink::buffer_size, 'x')), Error);
  }
  EXPECT_THROW(outputs.commit(), Error);
  EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(AtomicOutputs, SurviveAnInterrupt) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a", "old");
  const auto interrupted = [&] {
    AtomicOutputs outputs;
    outputs.stage(folder / "a").write(std::string(Sink::buffer_size + 1, 'x'));
    std::raise(SIGTERM);
  };
  EXPECT_EXIT(interrupted(), testing::KilledBySignal(SIGTERM), "");
  EXPECT_EQ(test::get_bytes(folder / "a"), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

}  // namespace
}  // namespace ductile::meshadapt::atomic_file_test
