#include "distributed/bisection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ductile/meshadapt/metric.hpp"

namespace ductile::distributed {

using meshadapt::Metric;

namespace {

struct Range {
  double low, high;
};

/// Extent and middle of an element along each axis.
template <int Dim>
struct Place {
  std::array<double, Dim> low, middle, high;
};

/// A range of ranks and the box that they share.
template <int Dim>
struct Node {
  int first, count;  // ranks
  int sign;          // direction in which its plane is displaced
  std::array<Range, Dim> along;
};

/// A search along one axis: the plane is in `range`, and the load `below` certainly before it.
struct Search {
  Range range;
  std::int64_t below = 0;
};

template <int Dim>
class Bisection {
 public:
  Bisection(const Communicator& comm, const Part& part, const std::vector<double>& load_of,
            Displaced displaced)
      : comm_(comm),
        part_(part),
        elements_(meshadapt::elements_in<Dim>(part.mesh).vertices),
        load_of_(load_of),
        displaced_(static_cast<int>(displaced)) {
    comm.on_all([&] {
      for (const auto& corners : elements_) place_of_.push_back(place_of(corners));
      node_of_.assign(elements_.size(), 0);
    });
    nodes_.push_back({0, comm.size(), 1, whole()});
  }

  std::vector<int> run() {
    while (divide()) {
    }
    return comm_.on_all([&] {
      std::vector<int> rank_of;
      for (const std::size_t node : node_of_) rank_of.push_back(nodes_[node].first);
      return rank_of;
    });
  }

 private:
  static constexpr std::size_t bins = 64, not_open = -1;
  static constexpr int searches = 4;  // each within a bin of the previous one
  /// Displacement of planes: this share of the load before a plane between two ranks; between more
  /// ranks about the same distance, which is a smaller share.
  static constexpr double displacement = 0.3;

  /// Axes are tilted a little, because in structured meshes many elements have equal coordinates.
  static double along(const std::array<double, Dim>& x, std::size_t axis) {
    constexpr std::array<double, 3> turned{1, 0.01, 0.003};
    double sum = 0;
    for (std::size_t k = 0; k < Dim; ++k) sum += turned[k] * x[(axis + k) % Dim];
    return sum;
  }

  Place<Dim> place_of(const meshadapt::Corners<Dim>& corners) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Place<Dim> place;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      double low = infinity, high = -infinity, sum = 0;
      for (const VertexId v : corners) {
        const double at = along(meshadapt::position_in<Dim>(part_.mesh, v).x, axis);
        low = std::min(low, at);
        high = std::max(high, at);
        sum += at;
      }
      place.low[axis] = low;
      place.high[axis] = high;
      place.middle[axis] = sum / (Dim + 1);
    }
    return place;
  }

  std::array<Range, Dim> whole() const {
    std::vector<double> ends(2 * Dim, -std::numeric_limits<double>::infinity());
    for (const Place<Dim>& place : place_of_)
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        ends[2 * axis] = std::max(ends[2 * axis], -place.middle[axis]);
        ends[2 * axis + 1] = std::max(ends[2 * axis + 1], place.middle[axis]);
      }
    ends = comm_.largest(std::move(ends));
    std::array<Range, Dim> ranges;
    for (std::size_t axis = 0; axis < Dim; ++axis)
      ranges[axis] = {-ends[2 * axis], ends[2 * axis + 1]};
    return ranges;
  }

  /// Divides each node of several ranks in two. Returns whether there were any.
  bool divide() {
    std::vector<std::size_t> open;  // nodes
    open_of_.assign(nodes_.size(), not_open);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (nodes_[n].count == 1) continue;
      open_of_[n] = open.size();
      open.push_back(n);
    }
    if (open.empty()) return false;
    const auto searches_of = search(open);
    const std::vector<std::int64_t> cut = cut_by(searches_of);
    std::vector<std::size_t> axis_of;
    std::vector<std::size_t> second_of;  // [open node], the node beyond its plane
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto first = cut.begin() + static_cast<std::ptrdiff_t>(i * Dim);
      axis_of.push_back(static_cast<std::size_t>(std::min_element(first, first + Dim) - first));
      second_of.push_back(nodes_.size());
      split(open[i], axis_of[i], searches_of[i * Dim + axis_of[i]].range.low);
    }
    visit_open([&](std::size_t e, std::size_t i) {
      const double plane = searches_of[i * Dim + axis_of[i]].range.low;
      if (place_of_[e].middle[axis_of[i]] >= plane) node_of_[e] = second_of[i];
    });
    return true;
  }

  /// Calls visit(element, open node) for the elements of open nodes.
  void visit_open(auto&& visit) const {
    for (std::size_t e = 0; e < elements_.size(); ++e)
      if (const std::size_t i = open_of_[node_of_[e]]; i != not_open) visit(e, i);
  }

  void split(std::size_t n, std::size_t axis, double plane) {
    Node<Dim> second = nodes_[n];
    Node<Dim>& first = nodes_[n];
    first.count /= 2;
    first.sign = -1;
    second.first += first.count;
    second.count -= first.count;
    second.sign = 1;
    first.along[axis].high = plane;
    second.along[axis].low = plane;
    nodes_.push_back(second);
  }

  /// [open node, axis] Finds planes: each is at the low end of the returned range.
  std::vector<Search> search(const std::vector<std::size_t>& open) const {
    std::vector<Search> all;
    for (const std::size_t n : open)
      for (const Range& range : nodes_[n].along) all.push_back({range});
    std::vector<std::int64_t> wanted;  // [open node], load wanted before its plane
    for (int time = 0; time < searches; ++time) {
      const std::vector<std::int64_t> loads = loads_in(all);
      if (time == 0) wanted = wanted_before(open, loads);
      for (std::size_t s = 0; s < all.size(); ++s)
        narrow(all[s], &loads[s * bins], wanted[s / Dim], time == searches - 1);
    }
    return all;
  }

  /// [open node, axis, bin] Loads of elements over all ranks.
  std::vector<std::int64_t> loads_in(const std::vector<Search>& all) const {
    std::vector<std::int64_t> loads = comm_.on_all([&] { return own_loads_in(all); });
    return comm_.sums(std::move(loads));
  }

  std::vector<std::int64_t> own_loads_in(const std::vector<Search>& all) const {
    std::vector<std::int64_t> loads(all.size() * bins, 0);
    visit_open([&](std::size_t e, std::size_t i) {
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        const auto& [low, high] = all[i * Dim + axis].range;
        const double at = place_of_[e].middle[axis];
        if (!(at >= low && at <= high)) continue;
        const double share = high > low ? (at - low) / (high - low) : 0;
        const auto bin = std::min(static_cast<std::size_t>(share * bins), bins - 1);
        loads[(i * Dim + axis) * bins + bin] += in_thousandths(load_of_[e]);
      }
    });
    return loads;
  }

  std::vector<std::int64_t> wanted_before(const std::vector<std::size_t>& open,
                                          const std::vector<std::int64_t>& loads) const {
    std::vector<std::int64_t> wanted;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Node<Dim>& node = nodes_[open[i]];
      std::int64_t all = 0;
      for (std::size_t b = 0; b < bins; ++b) all += loads[i * Dim * bins + b];
      const double half = static_cast<double>(node.count / 2) / node.count;
      const double shift = displacement * half * std::pow(2.0 / node.count, 1.0 / Dim);
      wanted.push_back(
          std::llround((half + displaced_ * node.sign * shift) * static_cast<double>(all)));
    }
    return wanted;
  }

  /// Narrows to the bin in which the wanted load ends; finally, to its closer end.
  static void narrow(Search& search, const std::int64_t* loads, std::int64_t wanted, bool is_last) {
    std::size_t bin = 0;
    while (bin + 1 < bins && search.below + loads[bin] <= wanted) search.below += loads[bin++];
    const auto [low, high] = search.range;
    const double width = (high - low) / bins;
    search.range = {low + static_cast<double>(bin) * width,
                    low + static_cast<double>(bin + 1) * width};
    if (is_last && 2 * (wanted - search.below) > loads[bin]) search.range.low = search.range.high;
  }

  /// [open node, axis] Number of target elements that the plane would cut, in thousandths.
  std::vector<std::int64_t> cut_by(const std::vector<Search>& all) const {
    std::vector<std::int64_t> cut = comm_.on_all([&] { return own_cut_by(all); });
    return comm_.sums(std::move(cut));
  }

  std::vector<std::int64_t> own_cut_by(const std::vector<Search>& all) const {
    std::vector<std::int64_t> cut(all.size(), 0);
    visit_open([&](std::size_t e, std::size_t i) {
      const Place<Dim>& place = place_of_[e];
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        const double plane = all[i * Dim + axis].range.low;
        if (place.low[axis] >= plane || place.high[axis] <= plane) continue;
        cut[i * Dim + axis] += in_thousandths(load_of_[e] * wanted_size(e, axis) /
                                              (place.high[axis] - place.low[axis]));
      }
    });
    return cut;
  }

  /// Target size of an element along an axis.
  double wanted_size(std::size_t element, std::size_t axis) const {
    Metric<Dim> sum{};
    for (const VertexId v : elements_[element])
      for (std::size_t k = 0; k < sum.m.size(); ++k)
        sum.m[k] += part_.wanted.values[v * sum.m.size() + k] / (Dim + 1);
    meshadapt::Vector<Dim> unit{};
    unit.x[axis] = 1;
    return std::sqrt(std::max(0.0, meshadapt::squared_length(meshadapt::inverse(sum), unit)));
  }

  const Communicator& comm_;
  const Part& part_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  const std::vector<double>& load_of_;
  int displaced_;
  std::vector<Place<Dim>> place_of_;  // [element]
  std::vector<std::size_t> node_of_;  // [element]
  std::vector<Node<Dim>> nodes_;
  std::vector<std::size_t> open_of_;  // [node], its index among the open ones, or not_open
};

}  // namespace

std::vector<int> bisected(const Communicator& comm, const Part& part,
                          const std::vector<double>& load_of, Displaced displaced) {
  return part.mesh.dimension == 2 ? Bisection<2>(comm, part, load_of, displaced).run()
                                  : Bisection<3>(comm, part, load_of, displaced).run();
}

}  // namespace ductile::distributed
