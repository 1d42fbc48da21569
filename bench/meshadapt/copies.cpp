#include "copies.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace ductile::bench {

namespace {

/// A process that runs the work, and the pipe from which to read its seconds.
struct Copy {
  pid_t process = 0;
  int from = -1;
};

[[noreturn]] void refuse(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Forks this process and runs the work in the child.
Copy start(const std::function<double()>& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) refuse("a pipe from a copy of the benchmark");
  const auto [from, to] = ends;
  const pid_t process = fork();
  if (process < 0) {
    const int error = errno;
    close(from), close(to);
    errno = error;
    refuse("a copy of the benchmark");
  }
  if (process == 0) {
    double seconds = 0;
    try {
      seconds = work();
    } catch (...) {  // a time of zero reports the failure
    }
    const bool told = write(to, &seconds, sizeof seconds) == sizeof seconds;
    _exit(told ? 0 : 1);
  }
  close(to);
  return {process, from};
}

/// The seconds that the copy reports; 0 if it fails.
double finish(const Copy& copy) {
  double seconds = 0;
  ssize_t bytes = 0;
  do bytes = read(copy.from, &seconds, sizeof seconds);
  while (bytes < 0 && errno == EINTR);
  const bool told = bytes == sizeof seconds;
  close(copy.from);
  waitpid(copy.process, nullptr, 0);
  return told ? seconds : 0;
}

/// Runs of the work per second by `copies` simultaneous copies.
double rate(const std::function<double()>& work, int copies) {
  std::vector<Copy> running(static_cast<std::size_t>(copies));
  for (Copy& copy : running) copy = start(work);
  double sum = 0;
  bool failed = false;
  for (const Copy& copy : running) {
    const double seconds = finish(copy);
    if (seconds > 0) {
      sum += 1 / seconds;
    } else {
      failed = true;
    }
  }
  if (failed) throw std::runtime_error("a copy of the benchmark failed");
  return sum;
}

/// Median of an odd number of values.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double speed_of_copies(const std::function<double()>& work, int copies) {
  constexpr int turns = 3;
  std::vector<double> alone, together;
  for (int turn = 0; turn < turns; ++turn) {
    alone.push_back(rate(work, 1));
    together.push_back(rate(work, copies));
  }
  return median(together) / median(alone);
}

}  // namespace ductile::bench
