#include "distributed/warnings.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace ductile::distributed {

namespace {

struct Told {
  std::string warning;
  std::vector<int> ranks;  // ascending
};

/// Adds the warnings of one rank, each terminated by a zero.
void add(std::vector<Told>& told, std::span<const char> text, int rank) {
  std::string warning;
  for (const char c : text) {
    if (c != '\0') {
      warning += c;
      continue;
    }
    const auto at = std::find_if(told.begin(), told.end(),
                                 [&](const Told& one) { return one.warning == warning; });
    if (at == told.end())
      told.push_back({warning, {rank}});
    else if (at->ranks.back() != rank)
      at->ranks.push_back(rank);
    warning.clear();
  }
}

std::string line(const Told& told) {
  std::string numbers;
  for (const int rank : told.ranks) numbers += (numbers.empty() ? "" : ", ") + std::to_string(rank);
  return (told.ranks.size() == 1 ? "rank " : "ranks ") + numbers + ": " + told.warning;
}

}  // namespace

meshadapt::Warnings warnings_of_ranks(const Communicator& comm, const meshadapt::Warnings& own) {
  if (comm.size() == 1) return own;
  PerRank<char> to(static_cast<std::size_t>(comm.size()));
  comm.on_all([&] {
    for (const std::string& warning : own) {
      to[0].insert(to[0].end(), warning.begin(), warning.end());
      to[0].push_back('\0');
    }
  });
  const Received<char> received = comm.exchange(to);
  return comm.on_all([&] {
    std::vector<Told> told;
    for (int rank = 0; rank < comm.size(); ++rank) add(told, received.from(rank), rank);
    meshadapt::Warnings lines;
    for (const Told& one : told) lines.push_back(line(one));
    return lines;
  });
}

}  // namespace ductile::distributed
