#include "move/mover.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "move/extension.hpp"
#include "move/part.hpp"
#include "move/walls.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// How steps and adaptations are chosen.
struct Steering {
  static constexpr double kept_quality = 0.6;  // see MoveOptions::keep_above
  static constexpr double worse = 0.99;        // elements below this times the quality that they
                                               // came with are adapted
  static constexpr double much_worse = 0.8;    // strained elements are below this times that
  static constexpr double growth = 1.5;        // of steps
  static constexpr double shortest = 2e-4;     // step, as a share of the way
  static constexpr int polishings = 3;         // at the end
  static constexpr double least_gain = 1.05;   // of the worst quality, by one of these
  static constexpr double required_gradation = 2.3;  // sizes at facets that stay are their own;
                                                     // Mmg's default
  static constexpr int tries = 2;  // to adapt where the way is blocked, the second wider
};
template <int Dim>
constexpr int layers_around = Dim == 2 ? 2 : 3;  // that are adapted around bad elements
/// Strained elements are below this times remesh_below.
template <int Dim>
constexpr double strained = Dim == 2 ? 1.5 : 1.25;

template <int Dim>
MovingMesh<Dim> moving_mesh(const Executor& executor, const FixedMesh<Dim>& topology, AnyMesh mesh,
                            const MoveOptions& options) {
  MovingMesh<Dim> result;
  const AnyField field = options.metric ? metric_of(*options.metric, mesh) : implied_metric(mesh);
  const std::vector<Metric<Dim>> tensors = tensors_of<Dim>(executor, field);
  result.site_of.resize(mesh.vertex_count());
  parallel_for(executor, result.site_of.size(), [&](std::size_t v) {
    result.site_of[v] = make_site(topology.position_of[v], tensors[v]);
  });
  result.start_of = topology.position_of;
  result.speed_of.resize(mesh.vertex_count());
  elements_in<Dim>(mesh).vertices = topology.corners_of;  // all turned the same way
  result.is_held.assign(topology.element_count(), 0);
  for (const std::uint32_t e : Dim == 2 ? mesh.required_triangles : mesh.required_tetrahedra)
    result.is_held[e] = 1;
  result.any = std::move(mesh);
  return result;
}

template <int Dim>
std::vector<Vector<Dim>> displacements(const Executor& executor, const AnyMesh& mesh,
                                       const AnyField& field) {
  expect_field_of(field, mesh);
  if (field.types.size() != 1 || field.types[0] != AnyField::Type::vector)
    throw InputError((field.name.empty() ? "displacement" : field.name) +
                     ": expected one vector at each vertex, found other fields");
  std::vector<Vector<Dim>> vectors = vectors_of<Dim>(field);
  const std::size_t bad = first_bad(executor, vectors.size(),
                                    [&](std::size_t v) { return !(norm(vectors[v]) <= 1e150); });
  if (bad != no_index)
    throw InputError((field.name.empty() ? "displacement" : field.name) + ": " +
                     entity("vertex", bad) + " has a displacement that is not finite");
  return vectors;
}

/// Adapts a part as move() is asked to.
template <int Dim>
AdaptedPart<Dim> adapted_part(const Executor& executor, const Part<Dim>& part,
                              const MoveOptions& options, MoveReport& report) {
  AdaptedMesh adapted = adapt(executor, part.mesh(), part.metric(),
                              {.smallest_size = options.smallest_size,
                               .largest_size = options.largest_size,
                               .gradation = options.gradation,
                               .required_gradation = Steering::required_gradation,
                               .insert = options.insert});
  ++report.adaptations;
  report.adapted_elements += part.elements().size();
  report.adapt_seconds += adapted.report.total_seconds;
  const std::vector<Metric<Dim>> metric_of = tensors_of<Dim>(executor, adapted.metric);
  AdaptedPart<Dim> result{std::move(adapted.mesh), {}, {}};
  for (std::size_t v = 0; v < metric_of.size(); ++v)
    result.site_of.push_back(make_site(position_in<Dim>(result.mesh, v), metric_of[v]));
  return result;
}

double chosen(double given, double in_2d, double in_3d, int dimension) {
  return given != 0 ? given : dimension == 2 ? in_2d : in_3d;
}

}  // namespace

template <int Dim>
Mover<Dim>::Mover(const Executor& executor, AnyMesh mesh, const AnyField& displacement,
                  const MoveOptions& options)
    : executor_(executor),
      options_(options),
      remesh_below_(chosen(options.remesh_below, 0.35, 0.2, Dim)),
      keep_above_(chosen(options.keep_above, 0.1, 0.08, Dim)),
      topology_(make_fixed_mesh<Dim>(executor, mesh)),
      paths_(executor, mesh, topology_, displacements<Dim>(executor, mesh, displacement), options),
      cargo_(executor, mesh, options) {
  mesh_ = moving_mesh(executor, topology_, std::move(mesh), options);
  mesh_.path_of = paths_.path_of();
  mesh_.is_rigid = paths_.rigid_elements(topology_);
  stride_ = paths_.first_stride();
  for (std::size_t e = 0; e < mesh_.is_held.size(); ++e) mesh_.is_held[e] |= mesh_.is_rigid[e];
  mesh_.made_with.assign(mesh_.is_held.size(), -1);
  connect();
  mesh_.came_with = mesh_.quality_of;
}

template <int Dim>
FixedMesh<Dim> Mover<Dim>::topology_now() {
  mesh_.any.coordinates.resize(mesh_.site_of.size() * Dim);
  parallel_for(executor_, mesh_.site_of.size(), [&](std::size_t v) {
    std::copy_n(mesh_.site_of[v].position.x.begin(), Dim, &mesh_.any.coordinates[v * Dim]);
  });
  return make_fixed_mesh<Dim>(executor_, mesh_.any);
}

template <int Dim>
void Mover<Dim>::connect() {
  topology_ = topology_now();
  mesh_.quality_of.resize(topology_.element_count());
  parallel_for(executor_, mesh_.quality_of.size(), [&](std::size_t e) {
    mesh_.quality_of[e] = quality_at(mesh_.site_of, topology_.corners_of[e]);
    if (mesh_.made_with[e] < 0) mesh_.made_with[e] = mesh_.quality_of[e];
  });
}

template <int Dim>
MovedMesh Mover<Dim>::run() {
  Marks blocking;
  int tries = 0;
  while (!is_done()) {
    if (report_.steps == options_.most_steps) {
      report_.stopped = "after " + std::to_string(report_.steps) + " steps, the most allowed";
      break;
    }
    if (step(blocking)) {
      tries = 0;
      if (is_done() || std::ranges::count(blocking, 1) == 0) continue;
      mark_bad(blocking);
      adapt_part(blocking, layers_around<Dim>, 0);
    } else {
      if (tries == Steering::tries || !adapt_part(blocking, layers_around<Dim> << 2 * tries, 0)) {
        report_.stopped = "because " + place_of_first(blocking) + " would be flattened";
        break;
      }
      ++tries;
    }
  }
  if (!report_.stopped.empty() && !options_.keep_partial)
    throw Error(mesh_.any.name + (mesh_.any.name.empty() ? "" : ": ") +
                "expected to move bodies all the way, stopped at " + number(100 * share_) +
                " % of it " + report_.stopped +
                "; give a way that is free, or keep the mesh of that place (keep_partial)");
  for (int times = 0; times < Steering::polishings; ++times) {
    blocking.assign(topology_.element_count(), 0);
    mark_bad(blocking);
    const bool better = adapt_part(blocking, layers_around<Dim> << times, Steering::least_gain);
    if (!better && *std::ranges::min_element(mesh_.quality_of) > keep_above_) break;
  }
  return finish();
}

template <int Dim>
bool Mover<Dim>::step(Marks& blocking) {
  double length = std::min(stride_, 1 - share_);
  Field position_of(mesh_.site_of.size()), move_of(position_of.size());
  parallel_for(executor_, position_of.size(), [&](std::size_t v) {
    position_of[v] = mesh_.site_of[v].position;
    move_of[v] = 2 * length * mesh_.speed_of[v];
  });
  const Walls<Dim> walls(mesh_.any, position_of);
  Marks is_free = paths_.within_reach(executor_, position_of, share_, share_ + length);
  parallel_for(executor_, is_free.size(), [&](std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    is_free[i] = is_free[i] && mesh_.path_of[i] == none && walls.may_move(v) &&
                 !topology_.elements_of(v).empty();
  });
  const Extension<Dim> extension(executor_, topology_, position_of, is_free, walls);
  blocking.assign(topology_.element_count(), 0);
  for (; length >= std::min(Steering::shortest, 1 - share_); length /= 2) {
    const double next = share_ + length > 1 - 1e-9 ? 1 : share_ + length;
    parallel_for(executor_, move_of.size(), [&](std::size_t v) {
      move_of[v] *= 0.5;  // a guess by the last attempt
      if (mesh_.path_of[v] != none) move_of[v] = paths_.at(mesh_.path_of[v], next) - position_of[v];
    });
    extension.solve(move_of);
    Marks bad(topology_.element_count(), 0);
    if (attempt(next, move_of, bad) == 0) {
      go_to(next, move_of);
      stride_ = Steering::growth * length;
      return true;
    }
    blocking = std::move(bad);
  }
  stride_ = 16 * Steering::shortest;
  return false;
}

template <int Dim>
std::size_t Mover<Dim>::attempt(double share, const Field& move_of, Marks& blocking) {
  next_site_of_ = mesh_.site_of;
  parallel_for(executor_, next_site_of_.size(), [&](std::size_t v) {
    const std::uint32_t path = mesh_.path_of[v];
    next_site_of_[v].position =
        path != none ? paths_.at(path, share) : mesh_.site_of[v].position + move_of[v];
  });
  parallel_for(executor_, next_site_of_.size(), [&](std::size_t v) {
    Metric<Dim>& metric = next_site_of_[v].metric;
    if (is_isotropic(metric)) return;
    const auto vertex = static_cast<VertexId>(v);
    const auto of_body = rotation_of_body(vertex, share);
    metric = of_body ? of_body->turned(metric)
                     : deformed<Dim>(metric, deformation_of(topology_.elements_of(vertex)));
  });
  next_quality_of_ = mesh_.quality_of;
  return runtime::parallel_reduce(
      executor_, blocking.size(), std::size_t{0},
      [&](std::size_t e) {
        const auto& corners = topology_.corners_of[e];
        if (std::ranges::all_of(corners, [&](VertexId v) { return move_of[v] == Vector<Dim>{}; }))
          return std::size_t{0};
        const double quality = next_quality_of_[e] = quality_at(next_site_of_, corners);
        const double least =
            mesh_.is_rigid[e] ? 0
                              : std::min(keep_above_, Steering::kept_quality * mesh_.made_with[e]);
        blocking[e] = !(quality > least);
        return std::size_t{blocking[e]};
      },
      std::plus<>());
}

/// The sum over elements of their deformation by the last attempt times their volume.
template <int Dim>
LinearMap<Dim> Mover<Dim>::deformation_of(std::span<const ElementId> elements) const {
  LinearMap<Dim> sum{};
  for (const ElementId e : elements) {
    std::array<Vector<Dim>, Dim + 1> before, after;
    for (std::size_t i = 0; i <= Dim; ++i) {
      before[i] = mesh_.site_of[topology_.corners_of[e][i]].position;
      after[i] = next_site_of_[topology_.corners_of[e][i]].position;
    }
    const LinearMap<Dim> map = deformation<Dim>(before, after);
    for (std::size_t i = 0; i < Dim; ++i) sum[i] += topology_.volume_of[e] * map[i];
  }
  return sum;
}

/// The rotation of the rigid body that a vertex belongs to.
template <int Dim>
std::optional<Rotation<Dim>> Mover<Dim>::rotation_of_body(VertexId v, double share) const {
  const std::uint32_t path = mesh_.path_of[v];
  return path == none ? std::nullopt : paths_.rotation(path, share_, share);
}

template <int Dim>
void Mover<Dim>::turn_fields(double share) {
  std::vector<Rotation<Dim>> at_vertex(mesh_.site_of.size()), of_element(mesh_.is_held.size());
  parallel_for(executor_, at_vertex.size(), [&](std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    const auto of_body = rotation_of_body(v, share);
    at_vertex[i] = of_body ? *of_body : rotation_of(deformation_of(topology_.elements_of(v)));
  });
  parallel_for(executor_, of_element.size(), [&](std::size_t i) {
    const auto e = static_cast<ElementId>(i);
    of_element[i] = rotation_of(deformation_of({&e, 1}));
  });
  cargo_.turn(NamedField::Place::vertices, at_vertex);
  cargo_.turn(NamedField::Place::elements, of_element);
}

template <int Dim>
void Mover<Dim>::go_to(double share, const Field& move_of) {
  if (cargo_.has_turned()) turn_fields(share);
  parallel_for(executor_, mesh_.site_of.size(),
               [&](std::size_t v) { mesh_.speed_of[v] = 1 / (share - share_) * move_of[v]; });
  mesh_.site_of = next_site_of_;
  mesh_.quality_of = next_quality_of_;
  share_ = share;
  ++report_.steps;
}

/// Strained elements are adapted, too, if there is anything to adapt.
template <int Dim>
void Mover<Dim>::mark_bad(Marks& marks) const {
  const auto mark_below = [&](double quality, double worse) {
    parallel_for(executor_, marks.size(), [&](std::size_t e) {
      if (mesh_.quality_of[e] < std::min(quality, worse * mesh_.came_with[e])) marks[e] = 1;
    });
  };
  mark_below(remesh_below_, Steering::worse);
  if (std::ranges::count(marks, 1) != 0)
    mark_below(strained<Dim> * remesh_below_, Steering::much_worse);
}

template <int Dim>
void Mover<Dim>::grow(Marks& marks, int layers) const {
  std::vector<std::uint8_t> near(mesh_.site_of.size());
  for (int layer = 0; layer < layers; ++layer) {
    parallel_for(executor_, near.size(), [&](std::size_t v) {
      near[v] = std::ranges::any_of(topology_.elements_of(static_cast<VertexId>(v)),
                                    [&](ElementId e) { return marks[e] != 0; });
    });
    parallel_for(executor_, marks.size(), [&](std::size_t e) {
      marks[e] = !mesh_.is_held[e] && std::ranges::any_of(topology_.corners_of[e],
                                                          [&](VertexId v) { return near[v] != 0; });
    });
  }
}

template <int Dim>
bool Mover<Dim>::adapt_part(Marks marks, int layers, double least_gain) {
  grow(marks, layers);
  if (!options_.remeshes || std::ranges::count(marks, 1) == 0) return false;
  FixedMesh<Dim> now = topology_now();
  cargo_.follow(topology_, now);
  topology_ = std::move(now);
  const Part<Dim> part(mesh_, topology_, marks);
  AdaptedPart<Dim> adapted = adapted_part(executor_, part, options_, report_);
  double worst = 1, worst_now = 1;
  for (const ElementId e : part.elements()) worst = std::min(worst, mesh_.quality_of[e]);
  for (const auto& corners : elements_in<Dim>(adapted.mesh).vertices)
    worst_now = std::min(worst_now, quality_at(adapted.site_of, corners));
  if (!(worst_now > least_gain * worst)) return false;
  adapted.origins = origins(executor_, part.mesh(), adapted.mesh);
  const Renewals renewals = part.put_back(mesh_, adapted);
  cargo_.replace(topology_, part, adapted.mesh, renewals);
  connect();
  cargo_.settle(topology_);
  return true;
}

template <int Dim>
std::string Mover<Dim>::place_of_first(const Marks& marks) const {
  const auto first = std::find(marks.begin(), marks.end(), 1);
  if (first == marks.end()) return "an element";
  const auto element = static_cast<std::size_t>(first - marks.begin());
  std::string place;
  for (int axis = 0; axis < Dim; ++axis) {
    double sum = 0;
    for (const VertexId v : topology_.corners_of[element]) sum += mesh_.site_of[v].position[axis];
    place += (axis == 0 ? "" : ", ") + number(sum / (Dim + 1));
  }
  return std::string("a ") + element_name<Dim>() + " at (" + place + ")";
}

template <int Dim>
MovedMesh Mover<Dim>::finish() {
  const FixedMesh<Dim> now = topology_now();
  cargo_.follow(topology_, now);
  MovedMesh result;
  std::vector<Metric<Dim>> metric_of(mesh_.site_of.size());
  for (std::size_t v = 0; v < metric_of.size(); ++v) metric_of[v] = mesh_.site_of[v].metric;
  result.metric = symmetric_field(executor_, metric_of, "metric");
  result.mesh = std::move(mesh_.any);
  result.fields = cargo_.take();
  report_.share = share_;
  report_.worst_quality = *std::min_element(mesh_.quality_of.begin(), mesh_.quality_of.end());
  result.report = std::move(report_);
  return result;
}

template <int Dim>
std::vector<double> Mover<Dim>::starts() const {
  std::vector<double> coordinates;
  for (const Vector<Dim>& start : mesh_.start_of)
    coordinates.insert(coordinates.end(), start.x.begin(), start.x.end());
  return coordinates;
}

template class Mover<2>;
template class Mover<3>;

}  // namespace ductile::meshadapt
