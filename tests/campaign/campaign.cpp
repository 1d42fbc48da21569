#include "campaign.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace ductile::campaign {
namespace {

using Clock = std::chrono::steady_clock;

const std::array<const char*, 5> names = {"right", "refused", "wrong", "crash", "timeout"};

/// A worker's report of a case, on one line: number, verdict, seconds, closed, rested, kind, fault.
struct Line {
  std::uint64_t number = 0;
  int verdict = 0;
  double seconds = 0;
  bool closed = false, rested = true;
  std::string kind, fault;
};

std::string text_of(const Line& line) {
  std::ostringstream text;
  text << line.number << ' ' << line.verdict << ' ' << line.seconds << ' ' << line.closed << ' '
       << line.rested << ' ' << line.kind << ' ' << line.fault << '\n';
  return text.str();
}

Line line_of(const std::string& text) {
  Line line;
  std::istringstream words(text);
  words >> line.number >> line.verdict >> line.seconds >> line.closed >> line.rested >> line.kind;
  std::getline(words >> std::ws, line.fault);
  return line;
}

/// Returns the fault without its numbers, so that faults of one kind are equal.
std::string kind_of_fault(const std::string& fault) {
  std::string kind;
  for (std::size_t i = 0; i < fault.size() && kind.size() < 150; ++i) {
    const char c = fault[i];
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    const bool inside = !kind.empty() && kind.back() == '#' &&
                        (c == '.' || c == 'e' || c == '+' || c == '-') && i + 1 < fault.size() &&
                        std::isdigit(static_cast<unsigned char>(fault[i + 1])) != 0;
    if (inside || (digit && !kind.empty() && kind.back() == '#')) continue;
    kind += digit ? '#' : c;
  }
  return kind;
}

// ---- Workers ----

std::filesystem::path folder_of(const Campaign& campaign, std::uint64_t number) {
  return campaign.folder / (std::to_string(campaign.seed) + "-" + std::to_string(number) +
                            (campaign.kind.empty() ? "" : "-" + campaign.kind));
}

void write_verdict(const Campaign& campaign, const Case& tried, std::uint64_t number,
                   const Outcome& outcome) {
  std::ofstream file(folder_of(campaign, number) / "verdict.txt");
  file << names[static_cast<std::size_t>(outcome.verdict)] << ", a case of kind '" << tried.kind
       << "'\nagain: ./dev campaign --seed " << campaign.seed << " --case " << number;
  if (!campaign.kind.empty()) file << " --kind " << campaign.kind;
  file << "\n";
  for (const std::string& fault : outcome.faults) file << fault << "\n";
}

Line try_number(const Campaign& campaign, std::uint64_t number) {
  const Case tried = make_case(campaign.seed, number, campaign.kind);
  const std::filesystem::path folder = folder_of(campaign, number);
  const Outcome outcome = try_case(tried, campaign.seed + number, folder, campaign.settings);
  if (outcome.verdict > Verdict::refused || (outcome.closed && !outcome.rested))
    write_verdict(campaign, tried, number, outcome);
  else if (campaign.count > 1)
    std::filesystem::remove_all(folder);
  Line line = {number,
               static_cast<int>(outcome.verdict),
               outcome.seconds,
               outcome.closed,
               outcome.rested,
               tried.kind,
               ""};
  if (!outcome.faults.empty()) line.fault = outcome.faults.front();
  for (char& c : line.fault)
    if (c == '\n') c = ' ';
  return line;
}

/// Tries every n-th case, from the worker's own number on, until time is over; n is the number of
/// workers.
void work(const Campaign& campaign, int worker, Clock::time_point end, std::FILE* out) {
  for (auto i = static_cast<std::uint64_t>(worker); i < campaign.count;
       i += static_cast<std::uint64_t>(campaign.workers)) {
    if (Clock::now() >= end) break;
    const std::string text = text_of(try_number(campaign, campaign.first + i));
    std::fwrite(text.data(), 1, text.size(), out);
    std::fflush(out);
  }
}

// ---- Summary ----

class Summary {
 public:
  void add(const Line& line) {
    ++count_[static_cast<std::size_t>(line.verdict)];
    ++kinds_[line.kind][static_cast<std::size_t>(line.verdict)];
    slowest_ = std::max(slowest_, line.seconds);
    if (line.closed) ++closed_;
    if (line.closed && !line.rested) restless_.push_back(line.number);
    if (line.verdict < 2) return;
    auto& cases = faults_[line.kind + ": " + kind_of_fault(line.fault)];
    cases.push_back(line);
  }

  bool print(const Campaign& campaign) const {
    for (const auto& [fault, cases] : faults_) {
      std::printf("%zu x %s\n", cases.size(), fault.c_str());
      std::printf("    e.g. %s\n    cases", cases[0].fault.c_str());
      for (std::size_t i = 0; i < cases.size() && i < 8; ++i)
        std::printf(" %llu", static_cast<unsigned long long>(cases[i].number));
      std::printf("\n");
    }
    std::printf("%-16s %8s %8s %8s %8s %8s\n", "kind", names[0], names[1], names[2], names[3],
                names[4]);
    for (const auto& [kind, count] : kinds_) print_row(kind, count);
    print_row("all", count_);
    const double share = closed_ == 0 ? 0 : static_cast<double>(restless_.size()) / closed_;
    std::printf("not at rest at the third call: %zu of %d (allowed: %g %%)", restless_.size(),
                closed_, 100 * campaign.restless_allowed);
    for (std::size_t i = 0; i < restless_.size() && i < 12; ++i)
      std::printf(" %llu", static_cast<unsigned long long>(restless_[i]));
    std::printf("\nslowest run: %.2f s; seed %llu; cases that failed are in %s\n", slowest_,
                static_cast<unsigned long long>(campaign.seed), campaign.folder.c_str());
    const bool rests = closed_ < 40 || share <= campaign.restless_allowed;
    return count_[2] + count_[3] + count_[4] == 0 && count_[0] > 0 && rests;
  }

 private:
  using Counts = std::array<int, 5>;

  static void print_row(const std::string& name, const Counts& count) {
    std::printf("%-16s %8d %8d %8d %8d %8d\n", name.c_str(), count[0], count[1], count[2], count[3],
                count[4]);
  }

  Counts count_{};
  std::map<std::string, Counts> kinds_;
  std::map<std::string, std::vector<Line>> faults_;
  std::vector<std::uint64_t> restless_;
  int closed_ = 0;
  double slowest_ = 0;
};

/// Starts the workers; all write their lines to one pipe.
std::FILE* start_workers(const Campaign& campaign, std::vector<pid_t>& children) {
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(60 * campaign.minutes));
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return nullptr;
  for (int worker = 0; worker < campaign.workers; ++worker) {
    const pid_t child = fork();
    if (child == 0) {
      close(ends[0]);
      int status = 0;
      try {
        work(campaign, worker, end, fdopen(ends[1], "w"));
      } catch (const std::exception& error) {
        std::fprintf(stderr, "campaign: worker %d: %s\n", worker, error.what());
        status = 1;
      }
      _exit(status);
    }
    children.push_back(child);
  }
  close(ends[1]);
  return fdopen(ends[0], "r");
}

}  // namespace

bool run_campaign(const Campaign& campaign) {
  std::fflush(stdout);
  std::vector<pid_t> children;
  std::FILE* lines = start_workers(campaign, children);
  if (lines == nullptr) return false;
  Summary summary;
  std::array<char, 8192> text{};
  while (std::fgets(text.data(), static_cast<int>(text.size()), lines) != nullptr)
    summary.add(line_of(text.data()));
  std::fclose(lines);
  bool fine = true;
  for (const pid_t child : children) {
    int status = 0;
    fine = waitpid(child, &status, 0) == child && status == 0 && fine;
  }
  if (!fine) std::printf("a worker of the campaign failed\n");
  return summary.print(campaign) && fine;
}

}  // namespace ductile::campaign
