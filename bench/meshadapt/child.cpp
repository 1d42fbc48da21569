#include "child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace ductile::bench {

namespace {

namespace fs = std::filesystem;

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Peak memory of a running process. The figure of wait4() is useless because it starts from the
/// parent's memory.
std::size_t peak_of(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.compare(0, 6, "VmHWM:") == 0) return std::stoul(line.substr(6)) * 1024;
  return 0;
}

/// Starts a process with its output discarded; returns none if the system refuses.
std::optional<pid_t> start(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? std::optional(process) : std::nullopt;
}

}  // namespace

ChildReport run_child(const std::vector<std::string>& words) {
  ChildReport report;
  const auto clock = std::chrono::steady_clock::now();
  const std::optional<pid_t> process = start(words);
  if (!process) return {.status = 127};
  int status = 0;
  rusage usage{};
  while (wait4(*process, &status, WNOHANG, &usage) == 0) {
    report.peak_memory = std::max(report.peak_memory, peak_of(*process));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  report.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  report.processor_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  report.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return report;
}

std::optional<fs::path> find_program(const std::string& name) {
  const char* folders = std::getenv("PATH");
  std::istringstream list(folders != nullptr ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    fs::path path = fs::path(folder.empty() ? "." : folder) / name;
    if (access(path.c_str(), X_OK) == 0 && fs::is_regular_file(path)) return path;
  }
  return std::nullopt;
}

}  // namespace ductile::bench
