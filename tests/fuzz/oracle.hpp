/// @file
/// What every input of a fuzzer is held to: files in memory, messages of one line, and an end with
/// words where something does not hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::fuzz {

/// Ends the program, so that libFuzzer keeps the input.
[[noreturn]] void fail(const std::string& why);

inline void expect(bool holds, const char* why) {
  if (!holds) fail(why);
}

/// One line, not empty, without control characters, not endless.
void expect_message(const std::string& text);
void expect_messages(const meshadapt::Warnings& lines);

/// Of an error about a file: names it first.
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

/// On one thread.
const runtime::Executor& executor();

}  // namespace ductile::fuzz
