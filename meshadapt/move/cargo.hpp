/// @file
/// Cargo<Dim>: the fields that go along with a moving mesh, by value or with their content.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/move.hpp"
#include "move/part.hpp"
#include "move/rigid_motion.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Cargo {
 public:
  /// Throws InputError unless the fields have a value for each entity of the mesh, and finite ones
  /// where these are carried conservatively.
  Cargo(const runtime::Executor& executor, const AnyMesh& mesh, const MoveOptions& options);

  bool has_turned() const;
  /// Turns the vectors and tensors of MoveOptions::turned at vertices or on elements.
  void turn(NamedField::Place place, const std::vector<Rotation<Dim>>& rotation_of);
  /// The mesh has the same entities as before, elsewhere: contents stay, so values change.
  void follow(const FixedMesh<Dim>& before, const FixedMesh<Dim>& after);
  /// A part was adapted and put back into the mesh that was `before`.
  void replace(const FixedMesh<Dim>& before, const Part<Dim>& part, const AnyMesh& adapted,
               const Renewals& renewals);
  /// Gives what replace() has taken from an integral back to the part, in the whole mesh `now`.
  void settle(const FixedMesh<Dim>& now);

  std::vector<NamedField> take() { return std::move(fields_); }

 private:
  bool keeps_content(std::size_t field) const;
  std::size_t components(std::size_t field) const;
  double integral(std::size_t field, std::size_t component, const FixedMesh<Dim>& mesh) const;
  void spread(std::size_t field, std::size_t component, double amount, const FixedMesh<Dim>& mesh);

  const runtime::Executor& executor_;
  std::vector<NamedField> fields_;
  std::vector<Carrying> carrying_;
  std::vector<std::uint8_t> is_turned_;             // [field]
  std::vector<std::vector<double>> content_;        // [field][component], before replace()
  std::vector<std::uint32_t> vertices_, elements_;  // of the part, that no other part shares
};

extern template class Cargo<2>;
extern template class Cargo<3>;

}  // namespace ductile::meshadapt
