/// @file
/// psi: the solution of the synthetic benchmark as a formula: short waves along x, and a moving
/// front with a jump in its middle; the same for all z.
#pragma once

namespace ductile::bench {

/// The level function whose sign changes at the jump of psi.
double psi_jump_level(double x, double y, double phase);

/// 0.1 sin(50 x + phase) + atan(-0.1 / (2 x - sin(5 y + phase))), phase = 2 pi t / T.
double psi(double x, double y, double phase);

struct PsiHessian {
  double xx = 0, xy = 0, yy = 0;
};

/// Second derivatives of psi beside its jump. At the jump there are none; meshes are adapted to
/// these.
PsiHessian psi_hessian(double x, double y, double phase);

}  // namespace ductile::bench
