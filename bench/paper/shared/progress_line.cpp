#include "shared/progress_line.hpp"

#include <cstdio>

#include "system.hpp"

namespace ductile::paper {

ProgressLine::ProgressLine()
    : terminal_(cli::stderr_is_terminal()), start_(Clock::now()), shown_(start_) {}

ProgressLine::~ProgressLine() {
  if (terminal_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(double done, const std::string& text) {
  const Clock::time_point now = Clock::now();
  if (now - shown_ < std::chrono::milliseconds(terminal_ ? 100 : 20'000)) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = done > 0 ? seconds * (1 - done) / done : 0;
  std::fprintf(stderr, "%s%3.0f %%, %.0f s, %.0f s to go: %s%s", terminal_ ? "\r\033[K" : "",
               100 * done, seconds, left, text.c_str(), terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace ductile::paper
