/// @file
/// Results as a table for people and as JSON for programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ductile::bench::irregular {

/// Median of one program on one input.
struct Measurement {
  std::string algorithm, input;
  std::string program;  ///< "serial", "Ductile", or another's name
  int threads = 1;
  double seconds = 0, serial_seconds = 0;
};

void print_head();
/// Prints a line immediately.
void print(const Measurement& measurement);

/// A JSON file that appears whole or not at all. The constructor throws std::runtime_error if it
/// cannot be written.
class JsonFile {
 public:
  /// Writes no file if the path is empty.
  explicit JsonFile(std::filesystem::path path);
  ~JsonFile();
  JsonFile(const JsonFile&) = delete;
  JsonFile& operator=(const JsonFile&) = delete;

  /// Writes the measurements and moves the file to its place.
  void write(const std::vector<Measurement>& measurements);

 private:
  std::filesystem::path path_, unfinished_;
};

}  // namespace ductile::bench::irregular
