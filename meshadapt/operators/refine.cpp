#include "operators/refine.hpp"

#include <algorithm>
#include <cmath>

#include "ductile/runtime/hash.hpp"
#include "operators/edges.hpp"

namespace ductile::meshadapt {

namespace {

/// Where along a-b its two halves have the same metric length, the size varying geometrically.
template <int Dim>
double metric_middle(const Site<Dim>& a, const Site<Dim>& b) {
  const Vector<Dim> d = b.position - a.position;
  const double ratio = std::sqrt(squared_length(b.metric, d) / squared_length(a.metric, d));
  if (std::abs(ratio - 1) < 1e-3) return 0.5;
  return std::clamp(std::log(0.5 * (1 + ratio)) / std::log(ratio), 0.2, 0.8);
}

}  // namespace

template <int Dim>
std::vector<LongEdge> Refine<Dim>::long_edges(const runtime::Executor& executor,
                                              const Mesh<Dim>& mesh, double long_edge,
                                              std::uint32_t after) {
  const auto marked = mark_changed(executor, mesh, after);
  return collect_edges<LongEdge>(executor, mesh, {marked, long_edge},
                                 [&](VertexId a, VertexId b, auto&& append) {
                                   append(LongEdge{a, b, static_cast<float>(mesh.length(a, b))});
                                 });
}

template <int Dim>
std::uint8_t Refine<Dim>::priority(const Item& edge) const {
  const double doublings = std::log2(std::max(1.0F, edge.length));
  return static_cast<std::uint8_t>(255 - std::min(255, static_cast<int>(24 * doublings)));
}

template <int Dim>
auto Refine<Dim>::plan(const Item& edge) const -> std::optional<Plan> {
  Plan plan;
  plan.a = edge.a;
  plan.b = edge.b;
  shell_of(mesh_, edge.a, edge.b, plan.shell);
  if (plan.shell.empty() || !may_split(plan.shell, edge.a, edge.b)) return {};
  locate(plan);
  // Where metrics are as thin as rounding is fine, what is between them may be no metric.
  if (!(plan.site.density > 0)) return {};
  if (!makes_no_short_edge(plan) || !keeps_shapes(plan, edge.length)) return {};
  return plan;
}

/// Required elements, facets and edges stay as they are.
template <int Dim>
bool Refine<Dim>::may_split(const Shell& shell, VertexId a, VertexId b) const {
  for (const ElementId e : shell) {
    if (mesh_.required_element(e)) return false;
    for (std::size_t i = 0; i <= Dim; ++i) {
      const VertexId opposite = mesh_.corners_of[e][i];
      if (opposite != a && opposite != b && mesh_.patches[mesh_.patches_of[e][i]].required)
        return false;
    }
  }
  if constexpr (Dim == 3) {
    const CurveId curve = mesh_.curve_of(a, b);
    if (curve != 0 && mesh_.curves[curve].required) return false;
  }
  return true;
}

/// Position, metric and classification of the new vertex.
template <int Dim>
void Refine<Dim>::locate(Plan& plan) const {
  const Site<Dim>& a = mesh_.site_of[plan.a];
  const Site<Dim>& b = mesh_.site_of[plan.b];
  // Off the middle by up to 5 %, lest a regular mesh be refined into a regular mesh of worse
  // shapes, in which no single change is an improvement.
  const double chance = runtime::mix32(plan.a * 31 + plan.b) * (2.0 / 4294967296.0) - 1;
  const double t = metric_middle(a, b) + 0.05 * chance;
  const Vector<Dim> position = (1 - t) * a.position + t * b.position;
  const auto sample = background_.sample(position, mesh_.host_of[t < 0.5 ? plan.a : plan.b]);
  plan.site = make_site(position, sample.metric);
  plan.host = sample.host;
  plan.kind.freedom = Dim;
  for (const ElementId e : plan.shell)
    if (const PatchId patch = patch_of_edge(mesh_, e, plan.a, plan.b)) {
      plan.entity = patch;
      plan.kind.freedom = Dim - 1;
    }
  if constexpr (Dim == 3)
    if (const CurveId curve = mesh_.curve_of(plan.a, plan.b)) {
      plan.entity = curve;
      plan.kind.freedom = 1;
    }
  const std::int32_t reference = mesh_.reference_of[plan.a];
  plan.reference = reference == mesh_.reference_of[plan.b] ? reference : 0;
}

template <int Dim>
bool Refine<Dim>::makes_no_short_edge(const Plan& plan) const {
  for (const ElementId e : plan.shell)
    for (const VertexId v : mesh_.corners_of[e])
      if (shorter_than(mesh_.site_of[v], plan.site, rules_.shortest_split)) return false;
  return true;
}

/// Shapes tell little of elements over which the metric changes a lot, as those of overlong edges.
template <int Dim>
bool Refine<Dim>::keeps_shapes(const Plan& plan, double length) const {
  double before = 1;
  for (const ElementId e : plan.shell) before = std::min<double>(before, mesh_.shape_of[e]);
  const double excess = std::max(1.0, length / rules_.overlong_edge);
  const double least =
      before < rules_.poor_shape
          ? before
          : std::min(rules_.split_keeps * before, rules_.accepted_shape) / (excess * excess);
  for (const ElementId e : plan.shell)
    for (const VertexId end : {plan.a, plan.b}) {
      auto sites = mesh_.sites(mesh_.corners_of[e]);
      sites[static_cast<std::size_t>(corner_of(mesh_.corners_of[e], end))] = &plan.site;
      const double after = shape<Dim>(sites);
      if (!(after > 0) || after < least) return false;
    }
  return true;
}

template <int Dim>
std::array<std::uint32_t, 2> Refine<Dim>::grow(const std::array<std::uint32_t, 2>& total) {
  const auto vertices = static_cast<std::uint32_t>(mesh_.vertex_slots());
  const auto elements = static_cast<std::uint32_t>(mesh_.element_slots());
  mesh_.grow(vertices + total[0], elements + total[1]);
  return {vertices, elements};
}

template <int Dim>
void Refine<Dim>::apply(const Plan& plan, runtime::Commit<Refine>& commit) {
  const VertexId middle = commit.fresh(0);
  mesh_.site_of[middle] = plan.site;
  mesh_.kind_of[middle] = plan.kind;
  mesh_.entity_of[middle] = plan.entity;
  mesh_.reference_of[middle] = plan.reference;
  mesh_.host_of[middle] = plan.host;
  mesh_.elements_of.reserve(
      middle, 2 * static_cast<std::uint32_t>(plan.shell.size()) + (Dim == 2 ? 4 : 16));
  for (const ElementId element : plan.shell) mesh_.elements_of.insert(middle, element);
  for (const ElementId element : plan.shell) {
    const ElementId fresh = commit.fresh(1);
    split_element(element, fresh, middle, plan);
    mesh_.elements_of.insert(middle, fresh);
    defer_remove(commit, plan.b, element);
    for (const VertexId v : mesh_.corners_of[fresh])
      if (v != middle) defer_add(commit, v, fresh);
  }
  if constexpr (Dim == 3) {
    if (plan.kind.freedom != 1) return;
    using Kind = ListChange::Kind;
    commit.defer(plan.a, {Kind::remove_link, plan.b, plan.entity});
    commit.defer(plan.a, {Kind::add_link, middle, plan.entity});
    commit.defer(plan.b, {Kind::remove_link, plan.a, plan.entity});
    commit.defer(plan.b, {Kind::add_link, middle, plan.entity});
    mesh_.links_of.insert(middle, {plan.a, plan.entity});
    mesh_.links_of.insert(middle, {plan.b, plan.entity});
  }
}

/// The element keeps its half at a, `fresh` is the half at b; the facet between them is new.
template <int Dim>
void Refine<Dim>::split_element(ElementId element, ElementId fresh, VertexId middle,
                                const Plan& plan) {
  const auto at_a = static_cast<std::size_t>(corner_of(mesh_.corners_of[element], plan.a));
  const auto at_b = static_cast<std::size_t>(corner_of(mesh_.corners_of[element], plan.b));
  mesh_.corners_of[fresh] = mesh_.corners_of[element];
  mesh_.patches_of[fresh] = mesh_.patches_of[element];
  mesh_.region_of[fresh] = mesh_.region_of[element];
  mesh_.corners_of[fresh][at_a] = middle;
  mesh_.patches_of[fresh][at_b] = 0;
  mesh_.corners_of[element][at_b] = middle;
  mesh_.patches_of[element][at_a] = 0;
  update_element(mesh_, element);
  update_element(mesh_, fresh);
}

template class Refine<2>;
template class Refine<3>;

}  // namespace ductile::meshadapt
