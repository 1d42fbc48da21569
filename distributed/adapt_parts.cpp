#include "distributed/adapt_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "distributed/adapt_zone.hpp"
#include "distributed/balance.hpp"
#include "distributed/grade.hpp"
#include "distributed/held.hpp"
#include "distributed/migrate.hpp"
#include "distributed/parts_geometry.hpp"
#include "distributed/warnings.hpp"

namespace ductile::distributed {

using runtime::Executor;

namespace {

/// A distributed mesh between two passes.
class Parts {
 public:
  Parts(const Communicator& comm, const Executor& executor, Part part,
        const AdaptPartsOptions& options)
      : comm_(comm), executor_(executor), options_(options), part_(std::move(part)) {}

  AdaptedParts run() {
    find_interfaces();
    find_geometry();
    limit_sizes();
    if (share_out(Displaced::not_at_all, is_scattered() ? 0 : beforehand)) find_interfaces();
    if (is_much_too_fine()) {
      coarsen();
      displace();
    }
    std::int64_t blocked = 0;  // in the last pass
    for (int pass = 1;; ++pass) {
      const PassReport report = adapt(pass);
      if (options_.told) options_.told(report);
      const std::int64_t before = std::exchange(blocked, report.blocked);
      if (pass >= options_.passes || !is_worthwhile(report, before)) break;
      displace();
    }
    share_out(Displaced::not_at_all, at_the_end);
    find_interfaces();
    const std::int64_t own = number_vertices(comm_, interfaces_, part_);
    auto warnings = warnings_of_ranks(comm_, warnings_);
    return {std::move(part_), std::move(interfaces_), own, std::move(warnings)};
  }

 private:
  static constexpr double beforehand = 1.2, at_the_end = 1.05;  // accepted imbalance
  static constexpr double much_too_fine = 1.75;  // ratio of elements to target elements
  static constexpr int layers = 3;               // layers around held entities that are adapted
                                                 // with them

  void find_interfaces() {
    comm_.on_all([&] { list_boundary(executor_, part_); });
    interfaces_ = distributed::find_interfaces(comm_, part_);
  }

  /// Makes the geometry from the current boundaries, for all passes and ranks.
  void find_geometry() {
    auto& make = options_.adapt.make;
    if (comm_.size() == 1 || make.geometry || make.hausdorff_tolerance == 0 || make.lock_boundary)
      return;
    make.geometry = geometry_of_parts(comm_, executor_, part_, make);
    make.functions.clear();
  }

  /// Applies the options' limits on sizes and growth to the target, across ranks too.
  void limit_sizes() {
    if (comm_.size() == 1) return;
    const bool at_curves = bounds_curved_sizes(options_.adapt);
    if (at_curves)
      part_.wanted =
          comm_.on_all([&] { return bound_at_curves(executor_, part_, interfaces_, options_); });
    const double growth = growth_of(options_.adapt);
    if (at_curves || growth > 0) grade(comm_, executor_, part_, interfaces_, growth);
  }

  /// Are interfaces everywhere, as between parts of every second element? Then nothing can be
  /// adapted, and interfaces cannot be displaced.
  bool is_scattered() const {
    const auto sums = comm_.sums({static_cast<std::int64_t>(interfaces_.facets.size()),
                                  static_cast<std::int64_t>(part_.element_count())});
    return 4 * sums[0] > sums[1];  // facets count on both sides
  }

  /// Redistributes elements unless the imbalance is accepted. Returns whether elements have moved.
  bool share_out(Displaced displaced, double accepted) {
    if (comm_.size() == 1) return false;
    const auto load_of = comm_.on_all([&] { return predicted_elements(part_); });
    expect_countable(comm_, load_of);
    if (imbalance(comm_, load_of) <= accepted) return false;
    part_ = migrate(comm_, executor_, part_, balanced(comm_, part_, load_of, displaced));
    return true;
  }

  /// Moves the planes to their next position.
  void displace() {
    constexpr std::array places{Displaced::not_at_all, Displaced::forth, Displaced::back};
    share_out(places[++times_displaced_ % places.size()], 0);
    find_interfaces();
    limit_sizes();
  }

  /// Will most elements be removed? Interfaces keep their sizes, so most elements would end up next
  /// to them.
  bool is_much_too_fine() const {
    if (comm_.size() == 1 || !options_.adapt.insert) return false;
    const auto load_of = comm_.on_all([&] { return predicted_elements(part_); });
    const double wanted = std::accumulate(load_of.begin(), load_of.end(), 0.0);
    const auto sums = comm_.sums({static_cast<std::int64_t>(load_of.size()), std::llround(wanted)});
    return static_cast<double>(sums[0]) > much_too_fine * static_cast<double>(sums[1]);
  }

  /// Collapses most short edges. The rest, at these interfaces, is removed in the first pass, in
  /// which interfaces are elsewhere.
  void coarsen() {
    AdaptPartOptions options = options_;
    options.adapt.approach_only = true;
    options.adapt.iterations = 1;
    options.adapt.swap = options.adapt.move = false;
    // The target is limited already, and is reached later.
    options.adapt.gradation = options.adapt.required_gradation = 0;
    options.adapt.curved_sizes = false;
    take(comm_.on_all([&] { return adapt_part(executor_, part_, interfaces_, options); }));
  }

  void take(AdaptedPart adapted) {
    std::move(adapted.report.warnings.begin(), adapted.report.warnings.end(),
              std::back_inserter(warnings_));
    part_ = std::move(adapted.part);
    interfaces_ = std::move(adapted.interfaces);
    number_vertices(comm_, interfaces_, part_);
  }

  PassReport adapt(int pass) {
    const double begin = MPI_Wtime();
    take(comm_.on_all([&] {
      if (pass == 1) return adapt_part(executor_, part_, interfaces_, options_);
      return adapt_zone(executor_, part_, interfaces_, held_elements(executor_, part_, layers),
                        options_);
    }));
    const EdgesAtInterfaces edges = comm_.on_all([&] {
      auto at_interfaces = edges_at_interfaces(part_, interfaces_);
      part_.is_held = std::move(at_interfaces.is_at_blocked);
      // Interfaces of later passes lie where the first pass has adapted.
      if (pass == 1)
        for (const SharedVertex& shared : interfaces_.vertices) part_.is_held[shared.vertex] = 1;
      return at_interfaces;
    });
    const auto elements = static_cast<std::int64_t>(part_.element_count());
    const auto sums = comm_.sums({elements, edges.all, edges.blocked});
    const std::int64_t most = comm_.largest(elements);
    const std::int64_t microseconds =
        comm_.largest(static_cast<std::int64_t>(1e6 * (MPI_Wtime() - begin)));
    return {pass,
            sums[0],
            sums[1],
            sums[2],
            static_cast<double>(most * comm_.size()) /
                static_cast<double>(std::max<std::int64_t>(1, sums[0])),
            1e-6 * static_cast<double>(microseconds)};
  }

  /// Is another pass worthwhile? A second pass always is, because the interfaces of the first come
  /// from the input. Without insertion, blocked edges cannot improve; and any mesh has a few of
  /// them, or as many as before.
  bool is_worthwhile(const PassReport& report, std::int64_t before) const {
    const auto& [insert, swap, move] =
        std::tie(options_.adapt.insert, options_.adapt.swap, options_.adapt.move);
    if (report.edges == 0 || !(insert || swap || move)) return false;
    if (report.pass < 2) return true;
    constexpr double few = 1e-3, hardly_fewer = 0.75;
    const auto blocked = static_cast<double>(report.blocked);
    return insert && blocked > few * static_cast<double>(report.edges) &&
           (report.pass < 3 || blocked < hardly_fewer * static_cast<double>(before));
  }

  const Communicator& comm_;
  const Executor& executor_;
  AdaptPartsOptions options_;  // with the geometry of all parts
  Part part_;
  Interfaces interfaces_;
  meshadapt::Warnings warnings_;
  std::size_t times_displaced_ = 0;
};

}  // namespace

std::string to_text(const PassReport& pass) {
  std::array<char, 160> text;
  std::snprintf(text.data(), text.size(),
                "pass %d: %lld elements, %lld of %lld edges around interfaces blocked, "
                "imbalance %.2f, %.3f s",
                pass.pass, static_cast<long long>(pass.elements),
                static_cast<long long>(pass.blocked), static_cast<long long>(pass.edges),
                pass.imbalance, pass.seconds);
  return text.data();
}

AdaptedParts adapt_parts(const Communicator& comm, const Executor& executor, Part part,
                         const AdaptPartsOptions& options) {
  return Parts(comm, executor, std::move(part), options).run();
}

}  // namespace ductile::distributed
