#include "child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigaction is POSIX's
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace ductile::campaign {
namespace {

using Clock = std::chrono::steady_clock;

// Wall-clock limit over processor-time limit: on a shared machine a program may get part of a core
// only.
constexpr double wall_factor = 5;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Runs in the child: replaces it by the program.
[[noreturn]] void become(const std::vector<std::string>& words, const std::filesystem::path& folder,
                         int errors, double limit_s) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  setpgid(0, 0);
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDIN_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  const rlimit no_core = {0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const auto cpu_s = static_cast<rlim_t>(std::ceil(limit_s));
  const rlimit cpu = {cpu_s, cpu_s + 1};
  setrlimit(RLIMIT_CPU, &cpu);
  if (chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
  _exit(127);
}

/// Reads until the child closes its end or time runs out. Returns whether it closed in time.
bool read_all(int pipe, Clock::time_point begin, double limit_s, std::string& text) {
  std::array<char, 4096> buffer;
  for (;;) {
    const double left = limit_s - seconds_since(begin);
    if (left <= 0) return false;
    pollfd waited = {pipe, POLLIN, 0};
    const int ready = poll(&waited, 1, static_cast<int>(left * 1000) + 1);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count <= 0) return true;
    if (text.size() < buffer.size()) text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

Ending run(const std::vector<std::string>& words, const std::filesystem::path& folder,
           double limit_s) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  const Clock::time_point begin = Clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) become(words, folder, ends[1], limit_s);
  close(ends[1]);
  Ending ending;
  const bool in_time = read_all(ends[0], begin, wall_factor * limit_s, ending.message);
  if (!in_time) kill(-child, SIGKILL);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  ending.seconds = seconds_since(begin);
  const bool used_up = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (!in_time || used_up) {
    ending.how = Ending::How::timed_out;
  } else if (WIFSIGNALED(status)) {
    ending.how = Ending::How::crashed;
    ending.status = WTERMSIG(status);
  } else {
    ending.status = WEXITSTATUS(status);
    if (ending.status == 127) throw std::runtime_error("cannot run " + words[0]);
    // Sanitizers end a program by an exit status of their own.
    if (ending.status > 2) ending.how = Ending::How::crashed;
  }
  return ending;
}

}  // namespace ductile::campaign
