#include "distributed/transfer_parts.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "distributed/gather_overlap.hpp"
#include "distributed/interfaces.hpp"

namespace ductile::distributed {

namespace {

using meshadapt::Joining;
using meshadapt::NamedField;

/// A communicator of the ranks that have elements.
class Busy {
 public:
  Busy(const Communicator& comm, const Part& part) {
    MPI_Comm_split(comm.handle(), part.element_count() > 0 ? 0 : MPI_UNDEFINED, comm.rank(),
                   &handle_);
  }
  ~Busy() {
    if (handle_ != MPI_COMM_NULL) MPI_Comm_free(&handle_);
  }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

  std::optional<Communicator> communicator() const {
    if (handle_ == MPI_COMM_NULL) return std::nullopt;
    return Communicator(handle_);
  }

 private:
  MPI_Comm handle_ = MPI_COMM_NULL;
};

/// Combines the values of all ranks at shared vertices.
class Joiner {
 public:
  Joiner(const Communicator& comm, const Interfaces& interfaces)
      : comm_(comm), interfaces_(interfaces) {}

  /// Combines values; first asks whether a rank has failed before. Collective.
  void join(std::span<double> values, std::size_t stride, Joining how) {
    has_told_ = true;
    comm_.agree(std::nullopt);
    const std::vector<double> own = comm_.on_all([&] { return at_shared(values, stride); });
    visit_at_vertices(
        comm_, interfaces_, own,
        [&](std::size_t i, int rank, const double* other) {
          const auto& [vertex, ranks] = interfaces_.vertices[i];
          combine(values.subspan(vertex * stride, stride), other, rank == ranks.front(), how);
        },
        stride);
    has_told_ = false;
  }

  /// Is an exception thrown now thrown on all ranks?
  bool has_told() const { return has_told_; }

 private:
  std::vector<double> at_shared(std::span<const double> values, std::size_t stride) const {
    std::vector<double> own;
    for (const SharedVertex& shared : interfaces_.vertices) {
      const auto at = values.subspan(shared.vertex * stride, stride);
      own.insert(own.end(), at.begin(), at.end());
    }
    return own;
  }

  /// Combines in the order of the ranks, so that all get the same bits.
  static void combine(std::span<double> result, const double* other, bool is_first, Joining how) {
    for (std::size_t k = 0; k < result.size(); ++k) {
      if (is_first)
        result[k] = other[k];
      else if (how == Joining::sum)
        result[k] += other[k];
      else if (how == Joining::least)
        result[k] = std::min(result[k], other[k]);
    }
  }

  const Communicator& comm_;
  const Interfaces& interfaces_;
  bool has_told_ = false;
};

/// Transfers this rank's fields, together with the other ranks that have elements. Throws the same
/// on all of these.
std::vector<NamedField> carried(const Communicator& comm, const runtime::Executor& executor,
                                const PartWithFields& from, const AnyMesh& to,
                                const Interfaces& interfaces,
                                const std::vector<meshadapt::Carrying>& carrying) {
  Joiner joiner(comm, interfaces);
  std::vector<NamedField> fields;
  const auto failure = failure_of([&] {
    const meshadapt::JoinParts join = [&](std::span<double> values, std::size_t stride,
                                          Joining how) { joiner.join(values, stride, how); };
    fields = meshadapt::transfer_fields(executor, {from.mesh, from.fields}, to, carrying,
                                        comm.size() > 1 ? join : meshadapt::JoinParts())
                 .fields;
  });
  if (failure && joiner.has_told()) throw AgreedError(*failure);
  comm.agree(failure);
  return fields;
}

}  // namespace

std::vector<NamedField> transfer_parts(const Communicator& comm, const runtime::Executor& executor,
                                       const FieldsOnPart& from, const Part& to,
                                       const std::vector<meshadapt::Carrying>& carrying) {
  const PartWithFields around = gather_overlap(comm, from.part, from.fields, to);
  std::vector<NamedField> fields;
  {
    const Busy busy(comm, to);
    const auto failure = failure_of([&] {
      if (const auto others = busy.communicator())
        fields =
            carried(*others, executor, around, to.mesh, find_interfaces(*others, to), carrying);
    });
    comm.agree(failure);
  }
  if (fields.empty())
    for (const NamedField& field : from.fields)
      fields.push_back({field.name, field.type, {}, field.place});
  return fields;
}

}  // namespace ductile::distributed
