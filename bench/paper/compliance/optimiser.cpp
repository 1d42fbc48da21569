#include "optimiser.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "cantilever.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace ductile::paper {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::FixedMesh;
using meshadapt::scalar_field;
using meshadapt::vector_field;
using meshadapt::VertexId;

namespace {

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Mean of the densities at the corners of each element, [element].
template <int Dim>
std::vector<double> mean_of_corners(const FixedMesh<Dim>& mesh,
                                    const std::vector<double>& density_of) {
  std::vector<double> mean_of;
  mean_of.reserve(mesh.element_count());
  for (const auto& corners : mesh.corners_of) {
    double sum = 0;
    for (const VertexId v : corners) sum += density_of[v];
    mean_of.push_back(sum / (Dim + 1));
  }
  return mean_of;
}

template <int Dim>
std::vector<double> stiffness_of_elements(const FixedMesh<Dim>& mesh,
                                          const std::vector<double>& density_of,
                                          const Problem& problem) {
  std::vector<double> value_of = mean_of_corners(mesh, density_of);
  for (double& value : value_of)
    value =
        problem.void_stiffness + (1 - problem.void_stiffness) * std::pow(value, problem.penalty);
  return value_of;
}

double weighted_sum(const std::vector<double>& value_of, const std::vector<double>& weight_of) {
  return std::inner_product(value_of.begin(), value_of.end(), weight_of.begin(), 0.0);
}

}  // namespace

double sharpness_at(const Path& path, int iteration) {
  const double doublings = std::log2(path.last_sharpness);
  const double done = 1.5 * iteration / path.iterations;  // share of the doubling phase
  return std::exp2(std::min(doublings, std::floor((doublings + 1) * done)));
}

double length_at(const Path& path, double minimum_length, int iteration) {
  if (path.first_length <= minimum_length) return minimum_length;
  const double done =
      std::log2(sharpness_at(path, iteration)) / std::log2(path.last_sharpness);  // 0 to 1
  return path.first_length * std::pow(minimum_length / path.first_length, done);
}

template <int Dim>
Optimiser<Dim>::Optimiser(const runtime::Executor& executor, const Settings& settings)
    : executor_(executor), settings_(settings) {
  use(cantilever_mesh<Dim>(settings.cells));
  design_of_.assign(any_.vertex_count(), settings.problem.volume_fraction);
}

template <int Dim>
void Optimiser<Dim>::use(AnyMesh any) {
  any_ = std::move(any);
  fixed_ = std::make_unique<FixedMesh<Dim>>(meshadapt::make_fixed_mesh<Dim>(executor_, any_));
  elasticity_ =
      std::make_unique<Elasticity<Dim>>(executor_, any_, *fixed_, settings_.problem.poisson);
  length_ = 0;
  domain_volume_ = std::accumulate(fixed_->share_of.begin(), fixed_->share_of.end(), 0.0);
}

template <int Dim>
void Optimiser<Dim>::use_filter(double length) {
  if (length == length_) return;
  filter_ = std::make_unique<HelmholtzFilter<Dim>>(*fixed_, length);
  length_ = length;
}

/// Adapts the mesh and transfers the design, and the displacement as an initial guess.
template <int Dim>
void Optimiser<Dim>::adapt_mesh() {
  const Adaptation& wanted = settings_.adaptation;
  const double smallest =
      wanted.smallest * length_at(settings_.path, settings_.problem.minimum_length, iteration_);
  const AnyField features = joined(scalar_field(Dim, density_of_, "density"),
                                   scalar_field(Dim, derivatives_.gain_of, "derivative"));
  const AnyField carried = joined(scalar_field(Dim, design_of_, "design"),
                                  vector_field<Dim>(displacement_of_, "displacement"));
  const meshadapt::SolutionMetric metric = meshadapt::solution_metric(
      executor_, any_, features,
      {.goal = {.complexity = meshadapt::complexity_of_elements(Dim, wanted.elements),
                .bounds = {smallest, wanted.largest, wanted.anisotropy}}});
  AnyMesh adapted =
      meshadapt::adapt(executor_, any_, metric.metric, {.gradation = wanted.gradation}).mesh;
  const AnyField moved = meshadapt::project_field(executor_, {any_, carried}, adapted).field;
  use(std::move(adapted));
  design_of_ = meshadapt::scalars_of(moved, 0);
  displacement_of_ = meshadapt::vectors_of<Dim>(moved, 1);
  for (double& density : design_of_) density = std::clamp(density, least_density, 1.0);
}

/// Filters and projects the design; returns the filtered design before the projection.
template <int Dim>
std::vector<double> Optimiser<Dim>::project(double sharpness) {
  std::vector<double> smooth_of = filter_->smooth(design_of_);
  for (double& density : smooth_of) density = std::clamp(density, 0.0, 1.0);
  const double volume = settings_.problem.volume_fraction * domain_volume_;
  projection_ = projection_of_volume(smooth_of, fixed_->share_of, {sharpness, volume});
  const Projection middle{sharpness, 0.5};
  density_of_.resize(smooth_of.size());
  missing_volume_ = volume;
  for (std::size_t v = 0; v < smooth_of.size(); ++v) {
    density_of_[v] = projection_(smooth_of[v]);
    missing_volume_ -= fixed_->share_of[v] * middle(smooth_of[v]);
  }
  return smooth_of;
}

template <int Dim>
double Optimiser<Dim>::analyse() {
  auto solution = elasticity_->solve(stiffness_of_elements(*fixed_, density_of_, settings_.problem),
                                     displacement_of_);
  displacement_of_ = std::move(solution.displacement_of);
  return solution.compliance;
}

/// The chain rule from elements through projection and filter to the design.
template <int Dim>
void Optimiser<Dim>::differentiate(const std::vector<double>& smooth_of) {
  const Problem& problem = settings_.problem;
  const std::vector<double> energy_of = elasticity_->unit_energy(displacement_of_);
  const std::vector<double> mean_of = mean_of_corners(*fixed_, density_of_);
  std::vector<double> gain_of(smooth_of.size(), 0), cost_of = fixed_->share_of;
  for (std::size_t e = 0; e < energy_of.size(); ++e) {
    const double slope =
        (1 - problem.void_stiffness) * problem.penalty * std::pow(mean_of[e], problem.penalty - 1);
    for (const VertexId v : fixed_->corners_of[e])
      gain_of[v] += slope * energy_of[e] * fixed_->volume_of[e] / (Dim + 1);
  }
  for (std::size_t v = 0; v < smooth_of.size(); ++v) {
    gain_of[v] *= projection_.slope(smooth_of[v]);
    cost_of[v] *= projection_.slope(smooth_of[v]);
  }
  derivatives_ = {filter_->smooth_integrated(gain_of), filter_->smooth_integrated(cost_of)};
}

template <int Dim>
Iteration Optimiser<Dim>::iterate() {
  const Clock whole;
  Iteration found{.number = iteration_, .sharpness = sharpness_at(settings_.path, iteration_)};
  found.length = length_at(settings_.path, settings_.problem.minimum_length, iteration_);
  const Adaptation& wanted = settings_.adaptation;
  if (wanted.elements > 0 && iteration_ > 0 && iteration_ % wanted.interval == 0) adapt_mesh();
  use_filter(found.length);
  found.adapt_seconds = whole.seconds();
  const std::vector<double> smooth_of = project(found.sharpness);
  const Clock analysis;
  found.compliance = analyse();
  found.solve_seconds = analysis.seconds();
  differentiate(smooth_of);
  found.elements = fixed_->element_count();
  found.volume_fraction = weighted_sum(density_of_, fixed_->share_of) / domain_volume_;
  found.change = improve_design(design_of_, derivatives_, fixed_->share_of,
                                {settings_.path.move_limit, missing_volume_});
  found.seconds = whole.seconds();
  ++iteration_;
  return found;
}

template <int Dim>
Judgement judge(const runtime::Executor& executor, const DensityOnMesh<Dim>& found,
                const AnyMesh& fine, const Problem& problem) {
  const AnyField density = scalar_field(Dim, found.density_of, "density");
  const AnyField there = meshadapt::interpolate_field(executor, {found.mesh, density}, fine).field;
  const auto mesh = meshadapt::make_fixed_mesh<Dim>(executor, fine);
  Elasticity<Dim> elasticity(executor, fine, mesh, problem.poisson);
  const double volume = std::accumulate(mesh.share_of.begin(), mesh.share_of.end(), 0.0);
  return {elasticity.solve(stiffness_of_elements(mesh, there.values, problem), {}).compliance,
          weighted_sum(there.values, mesh.share_of) / volume};
}

template class Optimiser<2>;
template class Optimiser<3>;
template Judgement judge(const runtime::Executor&, const DensityOnMesh<2>&, const AnyMesh&,
                         const Problem&);
template Judgement judge(const runtime::Executor&, const DensityOnMesh<3>&, const AnyMesh&,
                         const Problem&);

}  // namespace ductile::paper
