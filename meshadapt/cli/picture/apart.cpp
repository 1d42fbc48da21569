#include "apart.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "ductile/meshadapt/error.hpp"

namespace ductile::cli {
namespace {

/// The exit status of the child, which tells what it sends.
constexpr int made = 0, out_of_memory = 3, failed_with = 4, refused_with = 5;

void send(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::write(to, bytes.data(), bytes.size());
    if (sent < 0 && errno != EINTR) ::_exit(out_of_memory);
    if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// Does not return, so that nothing of the parent, such as its temporary files, is removed. The
/// parent reports errors.
[[noreturn]] void be_the_child(int to, const std::function<std::string()>& work) noexcept {
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  try {
    send(to, work());
    ::_exit(made);
  } catch (const meshadapt::InputError& error) {
    send(to, error.what());
    ::_exit(refused_with);
  } catch (const std::bad_alloc&) {
    ::_exit(out_of_memory);
  } catch (const std::exception& error) {
    send(to, error.what());
    ::_exit(failed_with);
  }
}

/// Reads to the end even without memory for the bytes, so that the child ends.
std::string receive(int from, bool& kept) noexcept {
  std::string bytes;
  std::array<char, 1 << 14> part;
  for (;;) {
    const ssize_t got = ::read(from, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    try {
      if (kept) bytes.append(part.data(), static_cast<std::size_t>(got));
    } catch (const std::bad_alloc&) {
      kept = false;
    }
  }
}

}  // namespace

std::string apart(const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return work();
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], work);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return work();
  }
  bool kept = true;
  std::string bytes = receive(ends[0], kept);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const int said = WIFEXITED(status) ? WEXITSTATUS(status) : out_of_memory;
  if (!kept || (said != made && said != failed_with && said != refused_with))
    throw std::bad_alloc();
  if (said == failed_with) throw meshadapt::Error(bytes);
  if (said == refused_with) throw meshadapt::InputError(bytes);
  return bytes;
}

}  // namespace ductile::cli
