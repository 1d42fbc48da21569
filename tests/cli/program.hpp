/// @file
/// Runs the real program in a folder of its own and returns its output.
#pragma once

#include <filesystem>
#include <string>

namespace ductile::cli {

struct Outcome {
  int status = -1;  ///< exit status
  std::string out, err;
};

/// Is this what the program says of one error: a line that begins so, and at most one more,
/// indented, that says what to do?
bool tells_one_error(const std::string& said);

/// A new empty folder, gone with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Runs `ENVIRONMENT ductile WORDS` here; all words are the shell's.
  Outcome run(const std::string& words, const std::string& environment = "") const;

  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  bool has(const std::string& name) const { return std::filesystem::exists(path_ / name); }
  /// Copies the bundled NAME.mesh and NAME.sol here.
  void add_example(const std::string& name) const;
  /// Number of files in it.
  std::size_t file_count() const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace ductile::cli
