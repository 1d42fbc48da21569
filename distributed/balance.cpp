#include "distributed/balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"

namespace ductile::distributed {

namespace {

std::int64_t sum_of(const std::vector<double>& load_of) {
  std::int64_t sum = 0;
  for (const double load : load_of) sum += in_thousandths(load);
  return sum;
}

/// Volume of an element; area in 2D.
template <int Dim>
double volume(const AnyMesh& mesh, const meshadapt::Corners<Dim>& corners) {
  std::array<meshadapt::Vector<Dim>, Dim> edge;
  for (std::size_t k = 0; k < Dim; ++k)
    edge[k] = meshadapt::position_in<Dim>(mesh, corners[k + 1]) -
              meshadapt::position_in<Dim>(mesh, corners[0]);
  const auto minor = [&](std::size_t i, std::size_t j) {
    return edge[Dim - 2].x[i] * edge[Dim - 1].x[j] - edge[Dim - 2].x[j] * edge[Dim - 1].x[i];
  };
  if constexpr (Dim == 2)
    return std::abs(minor(0, 1)) / 2;
  else
    return std::abs(edge[0].x[0] * minor(1, 2) + edge[0].x[1] * minor(2, 0) +
                    edge[0].x[2] * minor(0, 1)) /
           6;
}

/// Assigns parts to ranks, starting with the pairs that keep most elements.
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

/// Parts of equal load in the order of the elements, used if bisection leaves a part empty.
std::vector<int> parts_in_order(const Communicator& comm, const std::vector<double>& load_of) {
  const std::int64_t own = sum_of(load_of), before = comm.sum_before(own);
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

template <int Dim>
std::vector<double> predicted_elements(const Part& part) {
  const double elements_of_one = 1 / meshadapt::complexity_of_elements(Dim, 1);
  constexpr double at_least = 0.1;
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh).vertices;
  std::vector<double> density_of(part.mesh.vertex_count());
  for (VertexId v = 0; v < density_of.size(); ++v)
    density_of[v] = std::sqrt(std::max(0.0, meshadapt::determinant(wanted_at<Dim>(part, v))));
  std::vector<double> load_of;
  load_of.reserve(elements.size());
  for (const auto& corners : elements) {
    double density = 0;
    for (const VertexId v : corners) density += density_of[v] / (Dim + 1);
    load_of.push_back(
        std::max(at_least, elements_of_one * density * volume<Dim>(part.mesh, corners)));
  }
  return load_of;
}

}  // namespace

std::vector<double> predicted_elements(const Part& part) {
  if (part.element_count() == 0) return {};
  return part.mesh.dimension == 2 ? predicted_elements<2>(part) : predicted_elements<3>(part);
}

double imbalance(const Communicator& comm, const std::vector<double>& load_of) {
  const std::int64_t own = sum_of(load_of), all = comm.sum(own);
  if (all == 0) return 1;
  return static_cast<double>(comm.largest(own)) * comm.size() / static_cast<double>(all);
}

void expect_countable(const Communicator& comm, const std::vector<double>& load_of) {
  const double each = 1e-3 * static_cast<double>(comm.sum(sum_of(load_of))) / comm.size();
  if (each > std::numeric_limits<std::uint32_t>::max())
    throw meshadapt::InputError("metric: asks for about " + std::to_string(each) +
                                " elements on each rank, more than 32 bits count");
}

std::vector<int> balanced(const Communicator& comm, const Part& part,
                          const std::vector<double>& load_of, Displaced displaced) {
  std::vector<int> part_of = bisected(comm, part, load_of, displaced);
  if (leaves_one_empty(comm, part_of)) part_of = parts_in_order(comm, load_of);
  const std::vector<int> rank_of = ranks_of_parts(comm, part_of);
  for (int& target : part_of) target = rank_of[static_cast<std::size_t>(target)];
  return part_of;
}

}  // namespace ductile::distributed
