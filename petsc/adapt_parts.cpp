#include "adapt_parts.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "adapt_zone.hpp"
#include "balance.hpp"
#include "displace.hpp"
#include "grade.hpp"
#include "held.hpp"
#include "migrate.hpp"
#include "parts_geometry.hpp"

namespace ductile::petsc {

using runtime::Executor;

namespace {

/// A mesh between two passes.
template <int Dim>
class Parts {
 public:
  Parts(const Communicator& comm, const Executor& executor, Part part,
        const AdaptPartsOptions& options)
      : comm_(comm), executor_(executor), options_(options), part_(std::move(part)) {}

  AdaptedParts run() {
    std::vector<PassReport> reports;
    find_interfaces();
    find_geometry();
    balance(beforehand);
    end(Phase::balance);
    limit_sizes();
    for (int pass = 1;; ++pass) {
      reports.push_back(adapt(pass));
      reports.back().costs = take_costs();
      if (options_.told) options_.told(reports.back());
      if (pass >= options_.passes || !is_worthwhile(reports.back())) break;
      const std::vector<int> target_of = comm_.on_all([&] {
        return displaced<Dim>(part_, interfaces_, {comm_.rank(), pass - 1});
      });
      part_ = migrate<Dim>(comm_, part_, target_of);
      find_interfaces();
      end(Phase::migration);
      limit_sizes();
    }
    find_interfaces();
    balance(at_the_end);
    const std::int64_t own = number_vertices(comm_, interfaces_, part_);
    end(Phase::balance);
    return {std::move(part_), std::move(interfaces_), own, std::move(reports), take_costs()};
  }

 private:
  static constexpr double beforehand = 1.2, at_the_end = 1.05;  // the imbalance that may be
  static constexpr std::uint8_t layers = 3;  // around what was held, that are adapted with it

  /// What was done since the last phase ended is this phase's.
  void end(Phase phase) {
    const Costs now = comm_.costs();
    Costs& costs = costs_[static_cast<std::size_t>(phase)];
    costs.seconds += now.seconds - before_.seconds;
    costs.bytes += now.bytes - before_.bytes;
    before_ = now;
  }

  /// Of all ranks, since they were taken last.
  std::array<Costs, phase_count> take_costs() {
    std::vector<std::int64_t> all;
    for (const Costs& costs : costs_) {
      all.push_back(static_cast<std::int64_t>(1e6 * costs.seconds));
      all.push_back(costs.bytes);
    }
    all = comm_.sums(std::move(all));
    for (std::size_t p = 0; p < phase_count; ++p)
      costs_[p] = {1e-6 * static_cast<double>(all[2 * p]), all[2 * p + 1]};
    return std::exchange(costs_, {});
  }

  void find_interfaces() {
    comm_.on_all([&] { list_boundary(executor_, part_); });
    interfaces_ = {};
    if (comm_.size() > 1) interfaces_ = petsc::find_interfaces<Dim>(comm_, part_);
  }

  /// Boundaries are measured from what they are now, in all passes and on all ranks.
  void find_geometry() {
    auto& make = options_.adapt.make;
    if (comm_.size() == 1 || make.geometry || make.hausdorff_tolerance == 0 || make.lock_boundary)
      return;
    make.geometry = geometry_of_parts(comm_, executor_, part_, make);
    make.functions.clear();
    end(Phase::balance);
  }

  /// What is wanted keeps the sizes and the growth that the options allow, across ranks, too.
  void limit_sizes() {
    if (comm_.size() == 1) return;
    const bool at_curves = bounds_curved_sizes(options_.adapt);
    if (at_curves)
      part_.wanted = comm_.on_all(
          [&] { return bound_at_curves<Dim>(executor_, part_, interfaces_, options_); });
    const double growth = growth_of(options_.adapt);
    if (at_curves || growth > 0) grade<Dim>(comm_, executor_, part_, interfaces_, growth);
    end(Phase::gradation);
  }

  /// Interfaces everywhere, as between parts of every second element, leave nothing to adapt and
  /// nowhere to displace them.
  bool is_scattered() const {
    const auto sums = comm_.sums({static_cast<std::int64_t>(interfaces_.facets.size()),
                                  static_cast<std::int64_t>(part_.element_count())});
    return 4 * sums[0] > sums[1];  // facets count on both sides
  }

  void balance(double accepted) {
    if (comm_.size() == 1) return;
    const auto load_of = comm_.on_all([&] { return predicted_elements<Dim>(executor_, part_); });
    if (imbalance(comm_, load_of) <= accepted && !is_scattered()) return;
    part_ = migrate<Dim>(comm_, part_, balanced<Dim>(comm_, part_, interfaces_, load_of));
    find_interfaces();
  }

  PassReport adapt(int pass) {
    const double begin = MPI_Wtime();
    auto adapted = comm_.on_all([&] {
      if (pass == 1) return adapt_part<Dim>(executor_, part_, interfaces_, options_);
      return adapt_zone<Dim>(executor_, part_, interfaces_, held_elements<Dim>(part_, layers),
                             options_);
    });
    part_ = std::move(adapted.part);
    interfaces_ = std::move(adapted.interfaces);
    number_vertices(comm_, interfaces_, part_);
    const EdgesAtInterfaces edges = comm_.on_all([&] {
      part_.was_shared.assign(part_.number_of.size(), 0);
      for (const SharedVertex& shared : interfaces_.vertices) part_.was_shared[shared.vertex] = 1;
      return edges_at_interfaces<Dim>(part_, interfaces_);
    });
    const auto elements = static_cast<std::int64_t>(part_.element_count());
    const auto sums = comm_.sums({elements, edges.all, edges.blocked});
    const std::int64_t most = comm_.largest(elements);
    end(Phase::adaptation);
    const std::int64_t microseconds =
        comm_.largest(static_cast<std::int64_t>(1e6 * (MPI_Wtime() - begin)));
    return {pass,
            sums[0],
            sums[1],
            sums[2],
            static_cast<double>(most * comm_.size()) /
                static_cast<double>(std::max<std::int64_t>(1, sums[0])),
            1e-6 * static_cast<double>(microseconds),
            {}};
  }

  /// A second pass always is: the interfaces of the first were there before. Without insertion no
  /// more can be done to what is blocked.
  bool is_worthwhile(const PassReport& report) const {
    const auto& [insert, swap, move] =
        std::tie(options_.adapt.insert, options_.adapt.swap, options_.adapt.move);
    if (report.edges == 0 || !(insert || swap || move)) return false;
    return report.pass < 2 || (insert && report.blocked > 0);
  }

  const Communicator& comm_;
  const Executor& executor_;
  AdaptPartsOptions options_;  // with the geometry of all parts
  Part part_;
  Interfaces interfaces_;
  std::array<Costs, phase_count> costs_ = {};  // [phase], of this rank
  Costs before_ = comm_.costs();
};

}  // namespace

template <int Dim>
AdaptedParts adapt_parts(const Communicator& comm, const Executor& executor, Part part,
                         const AdaptPartsOptions& options) {
  return Parts<Dim>(comm, executor, std::move(part), options).run();
}

template AdaptedParts adapt_parts<2>(const Communicator&, const Executor&, Part,
                                     const AdaptPartsOptions&);
template AdaptedParts adapt_parts<3>(const Communicator&, const Executor&, Part,
                                     const AdaptPartsOptions&);

}  // namespace ductile::petsc
