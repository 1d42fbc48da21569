/// @file
/// The errors that Ductile's mesh adaptation throws. Their text is one line that names the file,
/// line or entity, what was expected, what was found and what to do; and the warnings of those
/// functions that go on regardless: the library prints nothing, its callers do.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ductile::meshadapt {

/// The text with control characters, which names of files may have, written as `\n` or `\x1b`: it
/// stays one line and changes nothing in a terminal. Thread safety: any thread.
std::string printable(std::string_view text);

/// Something outside the program failed: the disk is full, memory ran out, a result is not valid.
class Error : public std::runtime_error {
 public:
  /// The text is made printable.
  explicit Error(std::string_view text) : std::runtime_error(printable(text)) {}
  ~Error() override;  // defined in one place, so the type is one
};

/// What the user gave is wrong: a file, a mesh, a metric or an option. Of arrays in memory, what()
/// names the array and the index, counted from 0: "triangles.vertices[6]".
class InputError : public Error {
 public:
  using Error::Error;
  InputError(const std::string& what, const std::string& in_file);
  ~InputError() override;

  /// The same for users who gave a file, from which the arrays were read: entities are
  /// counted from 1, "triangle 7".
  const char* in_file() const noexcept;

 private:
  std::shared_ptr<const std::string> in_file_;  // null: as what()
};

/// What the caller has asked to be stopped, has stopped; there is no result.
class Cancelled : public Error {
 public:
  Cancelled();
  ~Cancelled() override;
};

/// What was met and not taken over, or looks doubtful: one line each, as in an error.
using Warnings = std::vector<std::string>;

}  // namespace ductile::meshadapt
