/// @file
/// The suite: algorithms, each with inputs, the serial code, Ductile's code, and a check of
/// results. A file in algorithms/ fills in a Row, whose types are not needed elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "inputs.hpp"

namespace ductile::bench::irregular {

/// An algorithm on one input. The serial code runs first.
class Problem {
 public:
  virtual ~Problem() = default;
  virtual bool has_ductile() const = 0;
  /// Returns the seconds of one run. Throws std::runtime_error, with the fault, if the result is
  /// not valid or differs from those of earlier runs.
  virtual double run_serially() = 0;
  virtual double run_ductile(const runtime::Executor& executor) = 0;
  /// Writes the input for another program; returns false if it has no such format.
  virtual bool write(std::ostream& out, Format format) const = 0;
};

struct Algorithm {
  std::string name;
  std::vector<std::string> inputs;
  std::function<std::unique_ptr<Problem>(const std::string& input, std::size_t size)> problem;
};

/// All algorithms.
std::vector<Algorithm> algorithms();

/// The functions of an algorithm. Results have operator==.
template <class Input, class Result>
struct Row {
  std::string name;
  std::vector<std::string> inputs;
  std::function<Input(const std::string& input, std::size_t size)> make_input;
  /// Makes the initial result before the clock starts; may be empty.
  std::function<Result(const Input&)> begin{};
  std::function<void(const Input&, Result&)> serial;
  /// Empty if Ductile has no such example.
  std::function<void(const runtime::Executor&, const Input&, Result&)> ductile{};
  /// Returns the fault of a result, or an empty text. Also called for the serial result.
  std::function<std::string(const Input&, const Result& result, const Result& serial)> fault;
};

/// Throws unless `fault` is empty.
inline void require_none(const std::string& fault, const std::string& whose) {
  if (!fault.empty()) throw std::runtime_error(whose + ' ' + fault);
}

template <class Input, class Result>
class RowProblem : public Problem {
 public:
  RowProblem(Row<Input, Result> row, Input input)
      : row_(std::move(row)), input_(std::move(input)) {}

  bool has_ductile() const override { return row_.ductile != nullptr; }

  double run_serially() override {
    return run("the serial code", serial_, [&](Result& result) { row_.serial(input_, result); });
  }
  double run_ductile(const runtime::Executor& executor) override {
    return run("Ductile on " + std::to_string(executor.threads()) + " threads", ductile_,
               [&](Result& result) { row_.ductile(executor, input_, result); });
  }
  bool write(std::ostream& out, Format format) const override {
    return write_input(out, format, input_);
  }

 private:
  /// `first` keeps the result of the first such run.
  template <class Solve>
  double run(const std::string& whose, std::optional<Result>& first, Solve&& solve) {
    Result result = row_.begin ? row_.begin(input_) : Result{};
    const auto start = std::chrono::steady_clock::now();
    solve(result);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (first) {
      require_none(result == *first ? "" : "gives another result than before", whose);
    } else {
      first = std::move(result);
      require_none(row_.fault(input_, *first, *serial_), whose);
    }
    return seconds.count();
  }

  Row<Input, Result> row_;
  Input input_;
  std::optional<Result> serial_, ductile_;
};

template <class Input, class Result>
Algorithm algorithm(Row<Input, Result> row) {
  return {row.name, row.inputs, [row](const std::string& input, std::size_t size) {
            return std::make_unique<RowProblem<Input, Result>>(row, row.make_input(input, size));
          }};
}

/// Returns `what` if the condition does not hold, otherwise an empty text.
inline std::string unless(bool as_it_should_be, const char* what) {
  return as_it_should_be ? "" : what;
}

}  // namespace ductile::bench::irregular
