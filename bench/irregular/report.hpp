/// @file
/// What was measured, as a table for people and as JSON for programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ductile::bench::irregular {

/// Medians of one program on an input.
struct Measurement {
  std::string algorithm, input;
  std::string program;  ///< "serial", "Ductile", or another's name
  int threads = 1;
  double seconds = 0, serial_seconds = 0;
};

void print_head();
/// A line, at once.
void print(const Measurement& measurement);

/// A file that appears whole or not at all. Throws std::runtime_error if it cannot be written, from
/// the start.
class JsonFile {
 public:
  /// Nowhere, if the path is empty.
  explicit JsonFile(std::filesystem::path path);
  ~JsonFile();
  JsonFile(const JsonFile&) = delete;
  JsonFile& operator=(const JsonFile&) = delete;

  /// Ductile's measurements, and the file in place.
  void write(const std::vector<Measurement>& measurements);

 private:
  std::filesystem::path path_, unfinished_;
};

}  // namespace ductile::bench::irregular
