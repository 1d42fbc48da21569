#include "oracle.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace ductile::fuzz {

void fail(const std::string& why) {
  std::fprintf(stderr, "fuzz: %s\n", why.c_str());
  std::abort();
}

void expect_message(const std::string& text) {
  expect(!text.empty(), "an empty message");
  if (text.size() > 2000) fail("a message without end: " + text.substr(0, 200));
  for (const unsigned char c : text)
    if (c < ' ' || c == 0x7f) fail("a control character in a message: " + text);
}

void expect_messages(const meshadapt::Warnings& lines) {
  expect(lines.size() < 1000, "too many warnings");
  for (const std::string& line : lines) expect_message(line);
}

void expect_message_of(const std::string& path, const std::string& text) {
  expect_message(text);
  if (text.compare(0, path.size(), path) != 0)
    fail("a message that does not name the file: " + text);
}

MemoryFile::MemoryFile() : file_(memfd_create("input", 0)) {
  if (file_ < 0) fail("no file in memory");
  path_ = "/dev/fd/" + std::to_string(file_);
}

MemoryFile::~MemoryFile() { close(file_); }

void MemoryFile::set(const std::uint8_t* bytes, std::size_t size) {
  // A writer to the path continues at this file's position, so that must be the beginning.
  if (ftruncate(file_, 0) != 0 || lseek(file_, 0, SEEK_SET) != 0 ||
      pwrite(file_, bytes, size, 0) != static_cast<ssize_t>(size))
    fail("no memory for the input");
}

const runtime::Executor& executor() {
  static const runtime::Executor one({.threads = 1});
  return one;
}

}  // namespace ductile::fuzz
