#include "report.hpp"

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

namespace ductile::bench::irregular {

void print_head() {
  std::printf("%-20s %-24s %-22s %7s %10s %10s %7s\n", "algorithm", "input", "program", "threads",
              "seconds", "serial", "ratio");
}

void print(const Measurement& measurement) {
  std::printf("%-20s %-24s %-22s %7d ", measurement.algorithm.c_str(), measurement.input.c_str(),
              measurement.program.c_str(), measurement.threads);
  if (measurement.seconds < 0)
    std::printf("%10s %10.5f\n", "failed", measurement.serial_seconds);
  else
    std::printf("%10.5f %10.5f %7.2f\n", measurement.seconds, measurement.serial_seconds,
                measurement.seconds / measurement.serial_seconds);
  std::fflush(stdout);
}

JsonFile::JsonFile(std::filesystem::path path) : path_(std::move(path)) {
  if (path_.empty()) return;
  unfinished_ = path_;
  unfinished_ += ".unfinished";
  if (!std::ofstream(unfinished_))
    throw std::runtime_error("cannot write '" + path_.string() + "': is its folder there?");
}

JsonFile::~JsonFile() {
  std::error_code ignored;
  if (!unfinished_.empty()) std::filesystem::remove(unfinished_, ignored);
}

void JsonFile::write(const std::vector<Measurement>& measurements) {
  if (path_.empty()) return;
  std::ofstream out(unfinished_);
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const Measurement& measurement : measurements)
    if (measurement.program == "Ductile")
      entries.push_back({{"algorithm", measurement.algorithm},
                         {"input", measurement.input},
                         {"threads", measurement.threads},
                         {"seconds", measurement.seconds},
                         {"serial_seconds", measurement.serial_seconds}});
  out << entries.dump(2) << '\n';
  out.close();
  if (!out) throw std::runtime_error("cannot write '" + path_.string() + "'");
  std::filesystem::rename(unfinished_, path_);
  unfinished_.clear();
}

}  // namespace ductile::bench::irregular
