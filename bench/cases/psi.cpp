#include "cases/psi.hpp"

#include <cmath>

namespace ductile::bench {

double psi_jump_level(double x, double y, double phase) { return 2 * x - std::sin(5 * y + phase); }

double psi(double x, double y, double phase) {
  return 0.1 * std::sin(50 * x + phase) + std::atan(-0.1 / psi_jump_level(x, y, phase));
}

/// Away from the jump, atan(-0.1 / level) differs by a constant from atan(level / 0.1), whose
/// derivatives are continuous across it.
PsiHessian psi_hessian(double x, double y, double phase) {
  constexpr double width = 0.1, waves = 50;
  const double level = psi_jump_level(x, y, phase);
  const double along_x = 2, along_y = -5 * std::cos(5 * y + phase);
  const double bend = 25 * std::sin(5 * y + phase);  // second derivative of the level along y
  const double spread = level * level + width * width;
  const double slope = width / spread, curvature = -2 * level * width / (spread * spread);
  return {curvature * along_x * along_x - 0.1 * waves * waves * std::sin(waves * x + phase),
          curvature * along_x * along_y, curvature * along_y * along_y + slope * bend};
}

}  // namespace ductile::bench
