#include "operators/edge_survey.hpp"

#include <span>
#include <utility>

namespace ductile::meshadapt {

namespace {

template <int Dim, int Space>
using Sites = std::array<const Site<Space>*, Dim + 1>;  ///< those of an element's corners

template <int Dim, int Space = Dim>
struct CornerLanes {
  std::array<LanesOf<Space>, Dim + 1> position;
  std::array<LanesOf<Metric<Space>::size>, Dim + 1> metric;
};

template <int Space>
[[gnu::always_inline]] inline void read(const std::array<const Site<Space>*, lane_count>& site,
                                        LanesOf<Space>& position,
                                        LanesOf<Metric<Space>::size>& metric) {
  static_assert(sizeof(Site<Space>) == (Space + Metric<Space>::size + 1) * sizeof(double));
  if constexpr (Space == 2) {
    transpose(site, 0, {&position[0], &position[1], &metric[0], &metric[1]});
    transpose(site, 2, {nullptr, nullptr, &metric[2], nullptr});
  } else {
    transpose(site, 0, {&position[0], &position[1], &position[2], &metric[0]});
    transpose(site, 4, {&metric[1], &metric[2], &metric[3], &metric[4]});
    transpose(site, 6, {nullptr, nullptr, &metric[5], nullptr});
  }
}

/// Sets the bits of one edge. The edge is a template argument, because otherwise the loop over
/// lanes would not be vectorised.
template <int Dim, int Space, std::size_t edge>
[[gnu::always_inline]] inline void compare(const CornerLanes<Dim, Space>& corner, double shorter,
                                           double longer, LanesIn<std::uint64_t>& bits) {
  constexpr auto a = static_cast<std::size_t>(Simplex<Dim>::edge[edge][0]);
  constexpr auto b = static_cast<std::size_t>(Simplex<Dim>::edge[edge][1]);
  constexpr std::uint64_t short_bit = std::uint64_t{1} << edge,
                          long_bit = short_bit << Simplex<Dim>::edges;
  const auto& [position, metric] = corner;
  for (std::size_t l = 0; l < lane_count; ++l) {
    Vector<Space> along;
    for (std::size_t i = 0; i < Space; ++i) along.x[i] = position[b][i][l] - position[a][i][l];
    const double at_a = squared_length(tensor_at<Space>(metric[a], l), along);
    const double at_b = squared_length(tensor_at<Space>(metric[b], l), along);
    const double greater = at_a > at_b ? at_a : at_b;
    bits[l] |= (at_a * at_b < shorter ? short_bit : 0) | (greater < longer ? 0 : long_bit);
  }
}

/// The bits of eight elements.
template <int Dim, int Space>
LanesIn<std::uint64_t> measured(std::span<const Sites<Dim, Space>, lane_count> sites,
                                const typename EdgeSurvey<Dim, Space>::Limits& limits) {
  constexpr double margin = 1e-12;
  const double below = limits.shorter * limits.shorter, above = limits.longer * limits.longer;
  const double shorter = (1 + margin) * (below * below), longer = (1 - margin) * above;
  CornerLanes<Dim, Space> corner;
  for (std::size_t c = 0; c <= Dim; ++c) {
    std::array<const Site<Space>*, lane_count> site;
    for (std::size_t l = 0; l < lane_count; ++l) site[l] = sites[l][c];
    read<Space>(site, corner.position[c], corner.metric[c]);
  }
  LanesIn<std::uint64_t> bits{};
  const auto compare_all = [&]<std::size_t... edge>(std::index_sequence<edge...>) {
    (compare<Dim, Space, edge>(corner, shorter, longer, bits), ...);
  };
  compare_all(std::make_index_sequence<Simplex<Dim>::edges>());
  return bits;
}

}  // namespace

/// Looks up sites ahead, so that lanes do not wait for each other.
template <int Dim, int Space>
void EdgeSurvey<Dim, Space>::measure(const Mesh<Dim, Space>& mesh, List& list) {
  std::array<Sites<Dim, Space>, stretch + lane_count> sites;
  for (std::size_t i = 0; i < list.size; ++i) {
    sites[i] = mesh.sites(mesh.corners_of[list.element[i]]);
    for (const Site<Space>* site : sites[i]) __builtin_prefetch(site);
  }
  for (std::size_t i = list.size; i % lane_count != 0; ++i) sites[i] = sites[i - 1];
  for (std::size_t i = 0; i < list.size; i += lane_count) {
    const auto bits = run_with(mesh.instructions, [&] {
      return measured<Dim, Space>(std::span(sites).subspan(i).template first<lane_count>(),
                                  limits_);
    });
    for (std::size_t l = 0; l < lane_count && i + l < list.size; ++l)
      bits_[list.element[i + l]] = static_cast<Bits>(bits[l] | known);
  }
}

template class EdgeSurvey<2>;
template class EdgeSurvey<2, 3>;
template class EdgeSurvey<3>;

}  // namespace ductile::meshadapt
