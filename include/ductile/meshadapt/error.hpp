/// @file
/// Errors and warnings of mesh adaptation. The text of an error is one line that names the file,
/// line or entity, what was expected, what was found and what to do. Functions that can continue
/// return warnings: the library prints nothing, its callers do.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ductile::meshadapt {

/// Returns the text with control characters, which file names may contain, written as `\n` or
/// `\x1b`: it stays one line and changes nothing in a terminal. Thread safety: any thread.
std::string printable(std::string_view text);

/// An external failure: the disk is full, memory ran out, a result is not valid.
class Error : public std::runtime_error {
 public:
  /// The text is made printable.
  explicit Error(std::string_view text) : std::runtime_error(printable(text)) {}
  ~Error() override;  // defined in one source, so that the type is unique
};

/// Invalid input: a file, a mesh, a metric or an option. For arrays in memory, what() names the
/// array and the index, counted from 0: "triangles.vertices[6]".
class InputError : public Error {
 public:
  using Error::Error;
  InputError(const std::string& what, const std::string& in_file);
  ~InputError() override;

  /// The text for users who gave a file: entities are counted from 1, "triangle 7".
  const char* in_file() const noexcept;

 private:
  std::shared_ptr<const std::string> in_file_;  // null: the same as what()
};

/// Thrown when the caller has cancelled the work; there is no result.
class Cancelled : public Error {
 public:
  Cancelled();
  ~Cancelled() override;
};

/// Things that were ignored or look doubtful: one line each, as in an error.
using Warnings = std::vector<std::string>;

}  // namespace ductile::meshadapt
