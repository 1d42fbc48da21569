/// @file
/// psi: the solution that the meshes of the synthetic benchmark follow, as a formula: short waves
/// along x, and a front that moves and has a jump in its middle; the same for all z.
#pragma once

namespace ductile::bench {

/// Where this changes sign, psi has its jump.
double psi_jump_level(double x, double y, double phase);

/// 0.1 sin(50 x + phase) + atan(-0.1 / (2 x - sin(5 y + phase))), phase = 2 pi t / T.
double psi(double x, double y, double phase);

struct PsiHessian {
  double xx = 0, xy = 0, yy = 0;
};

/// Second derivatives of psi beside its jump; they have none, so these are also what a mesh that
/// follows psi is made for.
PsiHessian psi_hessian(double x, double y, double phase);

}  // namespace ductile::bench
