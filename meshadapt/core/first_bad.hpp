/// @file
/// Shared by checks of a mesh: a parallel search for the first bad entity, and texts for entities
/// and numbers in messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

inline constexpr std::size_t no_index = static_cast<std::size_t>(-1);

/// The first index below n for which bad(index) holds, or no_index.
template <class Bad>
std::size_t first_bad(const runtime::Executor& executor, std::size_t n, Bad&& bad) {
  return runtime::parallel_reduce(
      executor, n, no_index, [&](std::size_t i) { return bad(i) ? i : no_index; },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

template <int Dim>
const char* element_name() {
  return Dim == 2 ? "triangle" : "tetrahedron";
}
template <int Dim>
const char* facet_name() {
  return Dim == 2 ? "edge" : "triangle";
}

/// An entity as files number it, from 1: "triangle 7".
inline std::string entity(const char* kind, std::size_t index) {
  return std::string(kind) + " " + std::to_string(index + 1);
}

/// A number with six digits.
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace ductile::meshadapt
