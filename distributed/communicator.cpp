#include "distributed/communicator.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace ductile::distributed {

Communicator::Communicator(MPI_Comm handle) : handle_(handle) {
  MPI_Comm_rank(handle, &rank_);
  MPI_Comm_size(handle, &size_);
}

std::int64_t Communicator::sum(std::int64_t value) const { return sums({value}).front(); }

std::int64_t Communicator::largest(std::int64_t value) const {
  std::int64_t result = value;
  MPI_Allreduce(&value, &result, 1, MPI_INT64_T, MPI_MAX, handle_);
  return result;
}

std::vector<double> Communicator::largest(std::vector<double> values) const {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                handle_);
  return values;
}

std::int64_t Communicator::sum_before(std::int64_t value) const {
  std::int64_t result = 0;
  MPI_Exscan(&value, &result, 1, MPI_INT64_T, MPI_SUM, handle_);
  return rank_ == 0 ? 0 : result;
}

std::vector<std::int64_t> Communicator::sums(std::vector<std::int64_t> values) const {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
                handle_);
  return values;
}

void Communicator::agree(const std::optional<std::string>& failure) const {
  int first = failure ? rank_ : size_;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, handle_);
  if (first == size_) return;
  std::string text;
  if (rank_ == first) text = (size_ > 1 ? "rank " + std::to_string(rank_) + ": " : "") + *failure;
  auto length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, first, handle_);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, first, handle_);
  throw AgreedError(text);
}

Communicator::Counts Communicator::exchange_counts(const std::vector<std::size_t>& sent) const {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max());
  Counts counts;
  const auto place = [&](const std::vector<int>& count, std::vector<int>& begin) {
    std::size_t end = 0;
    for (const int n : count) {
      begin.push_back(static_cast<int>(std::min(end, most)));
      end += static_cast<std::size_t>(n);
    }
    if (end > most) throw std::length_error("more items than MPI counts go from rank to rank");
  };
  on_all([&] {
    for (const std::size_t n : sent) counts.sent.push_back(static_cast<int>(std::min(n, most)));
    place(counts.sent, counts.sent_begin);
  });
  counts.received.resize(sent.size());
  MPI_Alltoall(counts.sent.data(), 1, MPI_INT, counts.received.data(), 1, MPI_INT, handle_);
  on_all([&] {
    place(counts.received, counts.received_begin);
    counts.begin.assign(counts.received_begin.begin(), counts.received_begin.end());
    counts.begin.push_back(
        std::accumulate(counts.received.begin(), counts.received.end(), std::size_t{0}));
  });
  return counts;
}

void Communicator::exchange_bytes(const void* sent, void* received, const Counts& counts,
                                  std::size_t bytes_each) const {
  MPI_Datatype item = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(bytes_each), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Alltoallv(sent, counts.sent.data(), counts.sent_begin.data(), item, received,
                counts.received.data(), counts.received_begin.data(), item, handle_);
  MPI_Type_free(&item);
}

}  // namespace ductile::distributed
