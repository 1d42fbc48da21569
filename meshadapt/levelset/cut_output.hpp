/// @file
/// write_cut(): makes the cut mesh from the mesh before and the snapped surface.
#pragma once

#include <vector>

#include "levelset/snap.hpp"

namespace ductile::meshadapt {

/// Throws InputError if the surface crosses something required. Thread safety: one caller; runs on
/// the executor.
template <int Dim>
CutMesh write_cut(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                  const Snapped& snapped, std::int32_t interface);

extern template CutMesh write_cut(const runtime::Executor&, const CutDomain<2>&, const Snapped&,
                                  std::int32_t);
extern template CutMesh write_cut(const runtime::Executor&, const CutDomain<3>&, const Snapped&,
                                  std::int32_t);

}  // namespace ductile::meshadapt
