#include "balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "elements_around.hpp"
#include "graph_partition.hpp"

namespace ductile::petsc {

namespace {

std::int64_t in_thousandths(const std::vector<double>& load_of) {
  std::int64_t sum = 0;
  for (const double load : load_of) sum += std::llround(1000 * std::min(load, 1e9));
  return sum;
}

/// Pairs of sorted facet and element: those that come twice are two elements side by side.
template <int Dim>
struct Side {
  meshadapt::Facet<Dim> facet;
  std::uint32_t element;
  friend auto operator<=>(const Side&, const Side&) = default;
};

template <int Dim>
std::vector<Side<Dim>> sorted_sides(const Part& part) {
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh).vertices;
  std::vector<Side<Dim>> sides;
  sides.reserve(elements.size() * (Dim + 1));
  for (std::uint32_t e = 0; e < elements.size(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      Side<Dim> side{meshadapt::facet_of<Dim>(elements[e], i), e};
      std::sort(side.facet.begin(), side.facet.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Calls join(a, b) for each two elements of a part that share a facet.
template <int Dim>
void each_two(const Part& part, auto&& join) {
  const auto sides = sorted_sides<Dim>(part);
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].facet == sides[i - 1].facet) join(sides[i - 1].element, sides[i].element);
}

/// The graph of elements that share a facet, over all parts. Collective.
template <int Dim>
ElementGraph graph_of(const Communicator& comm, const Part& part, const Interfaces& interfaces) {
  ElementGraph graph;
  const auto count = static_cast<std::int64_t>(part.element_count());
  graph.first = comm.sum_before(count);
  PerRank<std::int64_t> to(static_cast<std::size_t>(comm.size()));
  PerRank<std::uint32_t> element_at(to.size());
  std::vector<std::vector<std::int64_t>> beside(part.element_count());
  comm.on_all([&] {
    const ElementsAround<Dim> around(part.mesh);
    for (const SharedFacet& shared : interfaces.facets)
      around.visit_beside(meshadapt::facets_in<Dim>(part.mesh).vertices[shared.facet],
                          [&](std::uint32_t e) {
                            to[static_cast<std::size_t>(shared.rank)].push_back(graph.first + e);
                            element_at[static_cast<std::size_t>(shared.rank)].push_back(e);
                          });
    each_two<Dim>(part, [&](std::uint32_t a, std::uint32_t b) {
      beside[a].push_back(graph.first + b);
      beside[b].push_back(graph.first + a);
    });
  });
  const auto others = comm.exchange(to);
  comm.on_all([&] {
    for (int rank = 0; rank < comm.size(); ++rank)
      for (std::size_t k = 0; k < others.from(rank).size(); ++k)
        beside[element_at[static_cast<std::size_t>(rank)][k]].push_back(others.from(rank)[k]);
    graph.begin.push_back(0);
    for (const auto& list : beside) {
      graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
      graph.begin.push_back(static_cast<std::int64_t>(graph.neighbour.size()));
    }
  });
  return graph;
}

/// Which rank gets which part: the pairs with most elements that stay come first.
std::vector<int> ranks_of_parts(const Communicator& comm, const std::vector<int>& part_of) {
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::int64_t> stays(ranks * ranks, 0);
  for (const int part : part_of)
    ++stays[static_cast<std::size_t>(comm.rank()) * ranks + static_cast<std::size_t>(part)];
  stays = comm.sums(std::move(stays));
  std::vector<std::size_t> order(stays.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stays[a] > stays[b]; });
  std::vector<int> rank_of(ranks, -1);
  std::vector<std::uint8_t> has_part(ranks, 0);
  for (const std::size_t pair : order) {
    const std::size_t rank = pair / ranks, part = pair % ranks;
    if (has_part[rank] != 0 || rank_of[part] >= 0) continue;
    has_part[rank] = 1;
    rank_of[part] = static_cast<int>(rank);
  }
  return rank_of;
}

/// Parts of equal load in the order of the elements, which are where PT-Scotch leaves one empty.
std::vector<int> parts_in_order(const Communicator& comm, const std::vector<double>& load_of) {
  const std::int64_t own = in_thousandths(load_of), before = comm.sum_before(own);
  const auto all = static_cast<double>(std::max<std::int64_t>(1, comm.sum(own)));
  std::vector<int> part_of;
  auto at = static_cast<double>(before);
  for (const double load : load_of) {
    const double middle = at + 500 * load;
    at += 1000 * load;
    part_of.push_back(std::clamp(static_cast<int>(middle / all * comm.size()), 0, comm.size() - 1));
  }
  return part_of;
}

bool leaves_one_empty(const Communicator& comm, const std::vector<int>& part_of) {
  std::vector<std::int64_t> elements(static_cast<std::size_t>(comm.size()), 0);
  for (const int part : part_of) ++elements[static_cast<std::size_t>(part)];
  elements = comm.sums(std::move(elements));
  return std::find(elements.begin(), elements.end(), 0) != elements.end();
}

}  // namespace

template <int Dim>
std::vector<double> predicted_elements(const runtime::Executor& executor, const Part& part) {
  if (part.element_count() == 0) return {};
  constexpr double elements_of_one = Dim == 2 ? 2.35 : 11;  // as complexity_of_elements() has it
  constexpr double at_least = 0.1;
  const auto mesh = meshadapt::make_fixed_mesh<Dim>(executor, part.mesh);
  std::vector<double> load_of(mesh.element_count());
  std::vector<double> density_of(mesh.vertex_count());
  for (std::size_t v = 0; v < density_of.size(); ++v) {
    meshadapt::Metric<Dim> metric;
    std::copy_n(&part.wanted.values[v * metric.m.size()], metric.m.size(), metric.m.begin());
    density_of[v] = std::sqrt(std::max(0.0, meshadapt::determinant(metric)));
  }
  for (std::size_t e = 0; e < load_of.size(); ++e) {
    double density = 0;
    for (const VertexId v : mesh.corners_of[e]) density += density_of[v] / (Dim + 1);
    load_of[e] = std::max(at_least, elements_of_one * density * mesh.volume_of[e]);
  }
  return load_of;
}

double imbalance(const Communicator& comm, const std::vector<double>& load_of) {
  const std::int64_t own = in_thousandths(load_of), all = comm.sum(own);
  if (all == 0) return 1;
  return static_cast<double>(comm.largest(own)) * comm.size() / static_cast<double>(all);
}

template <int Dim>
std::vector<int> balanced(const Communicator& comm, const Part& part, const Interfaces& interfaces,
                          const std::vector<double>& load_of) {
  const ElementGraph graph = graph_of<Dim>(comm, part, interfaces);
  const std::int64_t all = comm.sum(in_thousandths(load_of));
  std::vector<std::int64_t> weight_of;
  comm.on_all([&] {
    constexpr double most = 1 << 29;  // PT-Scotch sums weights in 32 bits
    for (const double load : load_of)
      weight_of.push_back(
          std::max(1LL, std::llround(most * 1000 * load / static_cast<double>(all))));
  });
  std::vector<int> part_of = partition_graph(comm, graph, weight_of);
  if (leaves_one_empty(comm, part_of)) part_of = parts_in_order(comm, load_of);
  const std::vector<int> rank_of = ranks_of_parts(comm, part_of);
  for (int& target : part_of) target = rank_of[static_cast<std::size_t>(target)];
  return part_of;
}

template std::vector<double> predicted_elements<2>(const runtime::Executor&, const Part&);
template std::vector<double> predicted_elements<3>(const runtime::Executor&, const Part&);
template std::vector<int> balanced<2>(const Communicator&, const Part&, const Interfaces&,
                                      const std::vector<double>&);
template std::vector<int> balanced<3>(const Communicator&, const Part&, const Interfaces&,
                                      const std::vector<double>&);

}  // namespace ductile::petsc
