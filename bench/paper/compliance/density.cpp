#include "density.hpp"

#include <algorithm>
#include <cmath>

namespace ductile::paper {

double Projection::operator()(double density) const {
  const double below = std::tanh(sharpness * threshold);
  const double above = std::tanh(sharpness * (1 - threshold));
  return (below + std::tanh(sharpness * (density - threshold))) / (below + above);
}

double Projection::slope(double density) const {
  const double below = std::tanh(sharpness * threshold);
  const double above = std::tanh(sharpness * (1 - threshold));
  const double bend = std::tanh(sharpness * (density - threshold));
  return sharpness * (1 - bend * bend) / (below + above);
}

Projection projection_of_volume(std::span<const double> density_of,
                                std::span<const double> share_of, const VolumeGoal& goal) {
  double low = 0, high = 1;
  Projection projection{goal.sharpness, 0.5};
  for (int halving = 0; halving < 40; ++halving) {
    projection.threshold = 0.5 * (low + high);
    double volume = 0;
    for (std::size_t v = 0; v < density_of.size(); ++v)
      volume += share_of[v] * projection(density_of[v]);
    (volume > goal.volume ? low : high) = projection.threshold;
  }
  return projection;
}

double improve_design(std::vector<double>& design_of, const Derivatives& derivatives,
                      std::span<const double> share_of, const DesignStep& step) {
  const std::vector<double> old_of = design_of;
  const auto take = [&](double price) {
    double added = 0;
    for (std::size_t v = 0; v < old_of.size(); ++v) {
      const double factor = std::sqrt(std::max(derivatives.gain_of[v], 0.0) /
                                      (price * std::max(derivatives.cost_of[v], 1e-12)));
      const double low = std::max(least_density, old_of[v] - step.move_limit);
      const double high = std::min(1.0, old_of[v] + step.move_limit);
      design_of[v] = std::clamp(old_of[v] * factor, low, high);
      added += share_of[v] * derivatives.cost_of[v] * (design_of[v] - old_of[v]);
    }
    return added;
  };
  double low = -80, high = 80;  // logarithms of prices
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (take(std::exp(middle)) > step.added_volume ? low : high) = middle;
  }
  double change = 0;
  for (std::size_t v = 0; v < old_of.size(); ++v)
    change = std::max(change, std::abs(design_of[v] - old_of[v]));
  return change;
}

}  // namespace ductile::paper
