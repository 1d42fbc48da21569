/// @file
/// Schedule: which kernel runs when, how often and on what, as data. Phases follow each other, a
/// phase is a list of steps that is passed through until little changes, a step is one kernel.
///
/// `approach` is Algorithm 1 of the published method (Rokos, Gorman, Jensen, Kelly,
/// arXiv:1505.04694, 2015): rounds of coarsening, refinement, swapping and smoothing. Splits by
/// stages and all phases after it are ours (decisions 5, 7 and 27). A new kernel is a row of
/// `kernels` in adapt.hpp, a row of `kernel_rows` and the steps that use it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adapt/tuning.hpp"
#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {

constexpr std::size_t index_of(Kernel kernel) { return static_cast<std::size_t>(kernel); }

/// The aim of kernels that change lengths. The input is brought near the metric; then edges that
/// are still too short are collapsed even if that makes some too long, because splits and swaps
/// find a better way to fill the same place; in the end no edge leaves its range any more.
enum class Aim : std::uint8_t { approach, rearrange, finish };

/// A kernel looks first in a phase at changes since it last looked, at the whole mesh, or
/// only at later changes.
enum class Look : std::uint8_t { news, all, what_comes };

/// How smoothing moves vertices: towards the places where their elements would be regular, and to
/// better ones where elements stay poor; only the latter; or only to the model of the surface.
enum class Move : std::uint8_t { laplacian, optimise, to_surface };

/// One kernel, at one place of a phase. Shares are of the number of elements.
struct Step {
  Kernel kernel;
  int sweeps = 1;     ///< at most
  double enough = 0;  ///< a sweep that changes a smaller share is the last
  double below = 1;   ///< mean ratio of the elements that swaps and moves are for
  Move move = Move::laplacian;
  bool everywhere = false;  ///< looks at the whole mesh each time; in a mesh that came adapted at
                            ///< what has changed since the phase began
  double next_stage_below = 0;    ///< splits go on to the next stage at once while the pass has
                                  ///< changed a smaller share
  double renumber_above = never;  ///< first renumbers a mesh of which the pass has changed a
                                  ///< larger share, if it is not in order
};

/// Steps that are passed through several times.
struct Phase {
  Aim aim;
  std::span<const Step> steps;
  int passes = 1;                           ///< at most
  double calm = 0;                          ///< a pass that changes a smaller share is the last
  std::array<Look, kernels.size()> look{};  ///< [kernel]
};

/// The steps of all phases.
template <int Dim>
struct Steps {
  using T = Thresholds;
  using Of = Tuning<Dim>;
  static constexpr Step coarsen{
      .kernel = Kernel::coarsen, .sweeps = 8, .enough = T::many_collapses};
  static constexpr Step refine{.kernel = Kernel::refine};
  static constexpr Step swap{
      .kernel = Kernel::swap, .sweeps = 4, .enough = T::many_swaps, .below = Of::swap_below};
  static constexpr Step optimise{.kernel = Kernel::smooth, .below = Of::optimise_below};

  /// Refinement is one stage further in each round, or more if there is little else to do.
  static constexpr Step approach[] = {coarsen,
                                      {.kernel = Kernel::refine, .next_stage_below = 0.02},
                                      {.kernel = Kernel::swap,
                                       .sweeps = 8,
                                       .enough = T::many_swaps,
                                       .below = Of::swap_below,
                                       .renumber_above = Of::renumber_above},
                                      {.kernel = Kernel::smooth, .below = 0.3}};
  /// Collapses what is left of short edges, swaps and smooths, and only then splits what has become
  /// too long.
  static constexpr Step rearrange[] = {coarsen, swap, optimise, refine, swap, optimise};
  /// In 3D the next phase does what the last step would.
  static constexpr std::size_t rearrange_count = Dim == 2 ? 6 : 5;
  static constexpr Step settle[] = {
      {.kernel = Kernel::smooth, .move = Move::to_surface, .everywhere = true}};
  static constexpr Step polish[] = {{.kernel = Kernel::smooth, .sweeps = 3, .below = 0.5}, swap};
  static constexpr Step raise[] = {{.kernel = Kernel::smooth,
                                    .sweeps = 2,
                                    .below = Of::optimise_below,
                                    .move = Move::optimise,
                                    .everywhere = true}};
  static constexpr Step last_swap{
      .kernel = Kernel::swap, .sweeps = 4, .enough = T::any_swaps, .below = Of::swap_below};
  static constexpr Step finish[] = {coarsen,
                                    last_swap,
                                    refine,
                                    last_swap,
                                    {.kernel = Kernel::smooth,
                                     .below = Of::optimise_below,
                                     .move = Move::optimise,
                                     .everywhere = true}};
};

/// The phases of a run. The first goes on until the mesh is near the metric, see Adapter; those
/// that insert are left out where nothing may be inserted.
template <int Dim>
struct Schedule {
  Phase approach, rearrange, settle, polish, raise, finish;
};

template <int Dim>
Schedule<Dim> schedule_for(const AdaptOptions& options) {
  using S = Steps<Dim>;
  const Care& care = care_of<Dim>(options);
  return {
      .approach = {Aim::approach, S::approach, options.iterations, care.calm},
      .rearrange = {.aim = Aim::rearrange,
                    .steps = std::span(S::rearrange).first(S::rearrange_count),
                    .passes = Tuning<Dim>::rearrangements,
                    .look = {Look::all, Look::news, Look::news, Look::what_comes}},
      .settle = {Aim::rearrange, S::settle},
      .polish = {Aim::rearrange, S::polish, care.polishes},
      .raise = {Aim::rearrange, S::raise},
      // Until there is nothing to do: adapting the result again shall change nothing.
      .finish = {Aim::finish, S::finish, 10, 1e-4, {Look::all, Look::all, Look::all, Look::news}}};
}

template <int Dim, int Space>
class Workpiece;

/// The kernels as steps, each in a file of its own: as many sweeps as the step asks for, until one
/// changes little. They return how many changes they made.
template <int Dim, int Space>
std::size_t run_coarsen(Workpiece<Dim, Space>& work, const Step& step);
template <int Dim, int Space>
std::size_t run_refine(Workpiece<Dim, Space>& work, const Step& step);
template <int Dim, int Space>
std::size_t run_swap(Workpiece<Dim, Space>& work, const Step& step);
template <int Dim, int Space>
std::size_t run_smooth(Workpiece<Dim, Space>& work, const Step& step);

/// A kernel for the driver; its name and its report are in `kernels`.
template <int Dim, int Space = Dim>
struct KernelRow {
  std::size_t (*run)(Workpiece<Dim, Space>&, const Step&);
  bool AdaptOptions::*allowed;  ///< the option by which it may run
  bool renews;                  ///< makes or removes vertices or elements
  bool counts;                  ///< a pass is calm when such changes are few
};

template <int Dim, int Space>
inline constexpr std::array<KernelRow<Dim, Space>, kernels.size()> kernel_rows{
    {{run_coarsen<Dim, Space>, &AdaptOptions::insert, true, true},
     {run_refine<Dim, Space>, &AdaptOptions::insert, true, true},
     {run_swap<Dim, Space>, &AdaptOptions::swap, Dim == 3, true},
     {run_smooth<Dim, Space>, &AdaptOptions::move, false, false}}};

}  // namespace ductile::meshadapt
