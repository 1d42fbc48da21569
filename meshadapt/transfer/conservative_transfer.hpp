/// @file
/// ConservativeTransfer<Dim>: transfers a field by exact integrals over the intersections of
/// elements of both meshes. Steps: integrals of the old field times the new hat functions; the
/// lumped projection, which keeps bounds; the consistent one, which is closer; and a blend of both
/// that keeps bounds and only exchanges between neighbours, which keeps the integral.
#pragma once

#include <vector>

#include "ductile/meshadapt/transfer.hpp"
#include "transfer/coverage.hpp"
#include "transfer/evaluate.hpp"
#include "transfer/mass.hpp"
#include "transfer/overlaps.hpp"

namespace ductile::meshadapt {

template <int Dim>
class ConservativeTransfer {
 public:
  /// Refers to all arguments; `join` is given if the new mesh is part of a larger one.
  ConservativeTransfer(const runtime::Executor& executor, const Locator<Dim>& from,
                       const Components& field, const FixedMesh<Dim>& to, const JoinParts& join);

  std::vector<double> run(const ProjectionOptions& options);

  /// Call after run().
  const Coverage& coverage() const { return coverage_; }

 private:
  struct Range {
    double low, high;
  };
  using Square = std::array<std::array<double, Dim + 1>, Dim + 1>;

  void integrate();
  void integrate(std::size_t element, const Place<Dim>& centre, OverlapFinder<Dim>& finder);
  void fill(std::size_t element, const Place<Dim>& centre, OverlapFinder<Dim>& finder);
  Square mass_outside(std::size_t element, const Place<Dim>& centre,
                      OverlapFinder<Dim>& finder) const;
  void widen(std::size_t element, const double* values);
  std::vector<double> gather() const;
  std::vector<Range> ranges() const;
  void join_ranges(std::vector<Range>& range_of, Joining how) const;
  std::vector<double> blend(const std::vector<double>& lumped, const std::vector<double>& closest,
                            bool keep_bounds) const;
  std::vector<Range> permitted_shares(const std::vector<double>& lumped,
                                      const std::vector<double>& closest,
                                      const std::vector<Range>& range_of) const;

  std::size_t stride() const { return field_.stride; }

  const runtime::Executor& executor_;
  const Locator<Dim>& from_;
  Components field_;
  const FixedMesh<Dim>& to_;
  const JoinParts& join_;
  Mass<Dim> mass_;
  std::vector<double> moments_;  // [(element * corners + corner) * stride + component]
  std::vector<Range> seen_;      // [element * stride + component], range of nearby old values
  std::vector<double> covered_;  // [element], covered share of its volume
  Coverage coverage_;
};

extern template class ConservativeTransfer<2>;
extern template class ConservativeTransfer<3>;

}  // namespace ductile::meshadapt
