/// @file
/// Samples: what Google Benchmark wrote, read from its JSON. A benchmark's name says all that the
/// report knows of it:
///     SUBJECT/CASE/CANDIDATE/threads:N      e.g. loops/rising_1e5x200ns/gomp.dynamic/threads:2
/// Candidates of one subject and case do the same work and are compared. CANDIDATE is
/// LIBRARY.METHOD; the candidate `floor` is what none can be faster than. What follows threads:N is
/// ignored. Of a repeated benchmark every repetition is a sample, aggregates are ignored.
/// Counters ping_before_ns and ping_after_ns (ping_pong.hpp) say whether a sample counts; other
/// counters become columns.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ductile::bench::report {

inline const std::string floor_name = "floor";

struct Name {
  std::string subject, case_name, candidate;
  int threads = 1;
};

/// Nothing if the name does not follow the convention. Thread safety: pure function.
std::optional<Name> parse_name(const std::string& name);

/// What is before the first dot of a candidate; all of it if there is none.
std::string library_of(const std::string& candidate);

struct Sample {
  Name name;
  double ns = 0;                                        ///< of one iteration
  std::map<std::string, double> counters;               ///< without ping-pong
  std::optional<double> ping_before_ns, ping_after_ns;  ///< 0: the threads did not run at once
};

struct Failure {
  std::string name, message;
};

struct Samples {
  std::vector<Sample> samples;
  std::vector<Failure> failures;               ///< benchmarks that gave no figure, and why
  std::vector<Failure> unread;                 ///< files that are left out, and why
  std::map<std::string, std::string> machine;  ///< from the first file
};

/// A file that is not Google Benchmark's JSON, or breaks off, is left out as a whole and listed.
/// Throws std::runtime_error, naming it, if there is no other.
Samples read_samples(const std::vector<std::filesystem::path>& files);

}  // namespace ductile::bench::report
