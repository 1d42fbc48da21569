/// @file
/// Problems: collects the faults of a mesh, one line for each kind.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

class Problems {
 public:
  explicit Problems(const runtime::Executor& executor) : executor_(executor) {}

  /// Looks for i in [0, n) with bad(i). If there is one, adds the line describe(first) and returns
  /// false.
  template <class Bad, class Describe>
  bool expect_none(std::size_t n, Bad&& bad, Describe&& describe) {
    struct Found {
      std::size_t count = 0, first = static_cast<std::size_t>(-1);
    };
    const Found found = runtime::parallel_reduce(
        executor_, n, Found{},
        [&](std::size_t i) {
          return bad(i) ? Found{1, i} : Found{};
        },
        [](const Found& a, const Found& b) {
          return Found{a.count + b.count, std::min(a.first, b.first)};
        });
    if (found.count == 0) return true;
    std::string line = describe(found.first);
    if (found.count > 1) line += " (and " + std::to_string(found.count - 1) + " more like it)";
    lines_.push_back(std::move(line));
    return false;
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  const runtime::Executor& executor_;
  std::vector<std::string> lines_;
};

}  // namespace ductile::meshadapt
