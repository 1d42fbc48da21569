/// @file
/// Requirements on every input of a fuzzer: files in memory, one-line messages, and an abort with a
/// message if a requirement is broken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::fuzz {

/// Aborts, so that libFuzzer keeps the input.
[[noreturn]] void fail(const std::string& why);

inline void expect(bool holds, const char* why) {
  if (!holds) fail(why);
}

/// Expects one line: not empty, without control characters, of limited length.
void expect_message(const std::string& text);
void expect_messages(const meshadapt::Warnings& lines);

/// The same for an error about a file, whose message must begin with the path.
void expect_message_of(const std::string& path, const std::string& text);

/// A file in memory.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void set(const std::uint8_t* bytes, std::size_t size);
  const std::string& path() const { return path_; }

 private:
  int file_;
  std::string path_;
};

/// An executor of one thread.
const runtime::Executor& executor();

}  // namespace ductile::fuzz
