/// @file
/// Communicator: collective operations between ranks: sums, a list for each other rank, and
/// failures. Every rank of the communicator must call them, on the thread that initialised MPI.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/meshadapt/error.hpp"

namespace ductile::distributed {

/// A failure on one rank, thrown on all.
class AgreedError : public meshadapt::Error {
 public:
  using meshadapt::Error::Error;
};

/// Calls work(). Returns the text of its exception, if it throws one.
template <class Work>
std::optional<std::string> failure_of(Work&& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    return "there is not enough memory";
  } catch (const std::exception& error) {
    return error.what();
  }
  return std::nullopt;
}

/// Items received from each rank.
template <class T>
struct Received {
  std::vector<T> items;            // of rank 0, of rank 1, ...
  std::vector<std::size_t> begin;  // [rank], and one past the last

  std::span<const T> from(int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return std::span(items).subspan(begin[r], begin[r + 1] - begin[r]);
  }
};

/// A list for each rank.
template <class T>
using PerRank = std::vector<std::vector<T>>;

class Communicator {
 public:
  /// Refers to `handle`, which the caller owns.
  explicit Communicator(MPI_Comm handle);

  MPI_Comm handle() const { return handle_; }
  int rank() const { return rank_; }
  int size() const { return size_; }

  std::int64_t sum(std::int64_t value) const;
  std::int64_t largest(std::int64_t value) const;
  /// The maximum over the ranks of each of several values.
  std::vector<double> largest(std::vector<double> values) const;
  /// Sum over the ranks before this one.
  std::int64_t sum_before(std::int64_t value) const;
  /// The sum over the ranks of each of several values.
  std::vector<std::int64_t> sums(std::vector<std::int64_t> values) const;

  /// Throws AgreedError on all ranks if `failure` is set on any, with the text of the first.
  void agree(const std::optional<std::string>& failure) const;

  /// Calls work() on each rank; work() may not communicate. If it throws on one, an Error is thrown
  /// on all.
  template <class Work>
  auto on_all(Work&& work) const;

  /// Sends to[rank] to each rank. Throws std::length_error or std::bad_alloc, as Error on all
  /// ranks.
  template <class T>
  Received<T> exchange(const PerRank<T>& to) const;

 private:
  /// Numbers of items sent and received, and their offsets, checked to be small enough for MPI.
  struct Counts {
    std::vector<int> sent, sent_begin, received, received_begin;
    std::vector<std::size_t> begin;
  };
  Counts exchange_counts(const std::vector<std::size_t>& sent) const;
  void exchange_bytes(const void* sent, void* received, const Counts& counts,
                      std::size_t bytes_each) const;

  MPI_Comm handle_;
  int rank_ = 0, size_ = 1;
};

template <class Work>
auto Communicator::on_all(Work&& work) const {
  using Result = std::invoke_result_t<Work&>;
  std::conditional_t<std::is_void_v<Result>, std::optional<int>, std::optional<Result>> result;
  const std::optional<std::string> failure = failure_of([&] {
    if constexpr (std::is_void_v<Result>)
      work();
    else
      result.emplace(work());
  });
  agree(failure);
  if constexpr (!std::is_void_v<Result>) return *std::move(result);
}

template <class T>
Received<T> Communicator::exchange(const PerRank<T>& to) const {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::size_t> count;
  for (const auto& list : to) count.push_back(list.size());
  const Counts counts = exchange_counts(count);
  std::vector<T> sent;
  Received<T> received;
  on_all([&] {
    for (const auto& list : to) sent.insert(sent.end(), list.begin(), list.end());
    received.items.resize(counts.begin.back());
  });
  received.begin = counts.begin;
  exchange_bytes(sent.data(), received.items.data(), counts, sizeof(T));
  return received;
}

}  // namespace ductile::distributed
