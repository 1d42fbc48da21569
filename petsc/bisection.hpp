/// @file
/// Bisection: elements are shared out by planes across the axes, each of which divides what is on
/// one side of the planes before it. The planes of one pass are not where those of the last one
/// were, so that what was held on an interface is inside of a part in the next.
#pragma once

#include <cstdint>
#include <vector>

#include "communicator.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Which way planes are displaced from where they share loads out evenly: by some layers of
/// elements, neighbouring planes in opposite ways.
enum class Displaced : std::int8_t { back = -1, not_at_all = 0, forth = 1 };

/// [element] One of as many parts as ranks. Each plane is across the axis along which it cuts least
/// of the elements that are wanted. A part may be empty where there are few elements. The same
/// loads and places give the same parts, however they are distributed. Collective.
template <int Dim>
std::vector<int> bisected(const Communicator& comm, const Part& part,
                          const std::vector<double>& load_of, Displaced displaced);

extern template std::vector<int> bisected<2>(const Communicator&, const Part&,
                                             const std::vector<double>&, Displaced);
extern template std::vector<int> bisected<3>(const Communicator&, const Part&,
                                             const std::vector<double>&, Displaced);

}  // namespace ductile::petsc
