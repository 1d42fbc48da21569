#include "peers.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>

namespace ductile::bench::irregular {

namespace {

namespace fs = std::filesystem;

/// How to run a program. In `command`, {program}, {file}, {threads} and {repetitions} are replaced.
/// Each occurrence of `before_time` in the output precedes a time, in units of `unit` seconds.
struct Peer {
  const char *algorithm, *name, *program;
  Format format;
  const char *command, *before_time;
  double unit;
};

constexpr const char* pbbs =
    "PARLAY_NUM_THREADS={threads} {program} -r {repetitions} -o /dev/null {file}";
constexpr const char* pbbs_time = "Parlay time: ";
constexpr const char* galois_time = "Timer_0, TMAX, ";

constexpr Peer peers[] = {
    {"independent_set", "PBBS MIS", "MIS", Format::adjacency, pbbs, pbbs_time, 1},
    {"matching", "PBBS matching", "matching", Format::edges, pbbs, pbbs_time, 1},
    {"spanning_forest", "PBBS ST", "ST", Format::edges, pbbs, pbbs_time, 1},
    {"spanning_tree", "PBBS MST", "MST", Format::weighted_edges, pbbs, pbbs_time, 1},
    {"delaunay_insertion", "PBBS delaunay", "delaunay", Format::points, pbbs, pbbs_time, 1},
    {"independent_set", "Galois", "maximal-independentset-cpu", Format::galois,
     "{program} -symmetricGraph -t={threads} {file}", galois_time, 1e-3},
    {"shortest_paths", "Galois sssp", "sssp-cpu", Format::galois_weighted,
     "{program} -symmetricGraph -startNode=0 -t={threads} {file}", galois_time, 1e-3},
};

std::optional<fs::path> on_path(const char* program) {
  const char* folders = std::getenv("PATH");
  std::istringstream list(folders != nullptr ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    fs::path path = fs::path(folder.empty() ? "." : folder) / program;
    if (access(path.c_str(), X_OK) == 0 && fs::is_regular_file(path)) return path;
  }
  return std::nullopt;
}

/// A temporary file, removed by the destructor.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_(fs::temp_directory_path() / ("irregular_bench-" + std::to_string(getpid()))) {}
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void replace(std::string& text, const std::string& name, const std::string& value) {
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size()))
    text.replace(at, name.size(), value);
}

std::string quoted(const fs::path& path) {
  std::string text = path.string();
  replace(text, "'", "'\\''");
  return "'" + text + "'";
}

/// The output of a command; empty if it fails.
std::string output_of(const std::string& command) {
  std::string output;
  FILE* const pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 4096> part{};
  while (const std::size_t length = std::fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), length);
  return pclose(pipe) == 0 ? output : std::string();
}

/// The median of the times in a program's output, or -1.
double median_time(const std::string& output, std::string_view before_time) {
  std::vector<double> times;
  for (auto at = output.find(before_time); at != std::string::npos;
       at = output.find(before_time, at + 1)) {
    const char* const number = output.c_str() + at + before_time.size();
    char* end = nullptr;
    const double time = std::strtod(number, &end);
    if (end != number) times.push_back(time);
  }
  if (times.empty()) return -1;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

}  // namespace

std::vector<Measurement> measure_peers(const std::string& algorithm, const Problem& problem,
                                       const std::vector<int>& thread_counts, int repetitions) {
  std::vector<Measurement> measurements;
  for (const Peer& peer : peers) {
    const auto program = algorithm == peer.algorithm ? on_path(peer.program) : std::nullopt;
    if (!program) continue;
    const TemporaryFile file;
    std::ofstream out(file.path(), std::ios::binary);
    if (!problem.write(out, peer.format)) continue;
    out.close();
    for (const int threads : thread_counts) {
      std::string command = peer.command;
      replace(command, "{program}", quoted(*program));
      replace(command, "{file}", quoted(file.path()));
      replace(command, "{threads}", std::to_string(threads));
      replace(command, "{repetitions}", std::to_string(repetitions));
      const double time = median_time(output_of(command), peer.before_time);
      measurements.push_back({algorithm, {}, peer.name, threads, time < 0 ? -1 : time * peer.unit});
    }
  }
  return measurements;
}

}  // namespace ductile::bench::irregular
