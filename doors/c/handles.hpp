/// @file
/// The objects behind the handles of ductile.h, and the conversion of exceptions to codes.
#pragma once

#include <cstdint>
#include <exception>
#include <initializer_list>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "ductile.h"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/level_set.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace ductile::c {
struct Cut;  // level_set.hpp
}

/// A mesh. Metric and report are empty unless it is an adapted one.
struct ductile_mesh {
  ductile::meshadapt::AnyMesh mesh;
  ductile::meshadapt::AnyField metric;
  ductile::meshadapt::AdaptReport report;
  std::shared_ptr<const ductile::c::Cut> cut = nullptr;  // of a mesh from ductile_cut()
  ductile::meshadapt::Origins origins = {};              // of a mesh from ductile_move()
};

struct ductile_options {
  ductile::meshadapt::AdaptOptions adapt;
  ductile::meshadapt::CutOptions cut;
  ductile::runtime::ExecutorOptions executor;
  double elements = 0, norm = 2;  // goal of the metric of a solution
  bool projection = false;        // recovers second derivatives by double projection
};

struct ductile_sizes {
  int dimension = 0;
  ductile::meshadapt::Sizes sizes;
  ductile::meshadapt::SizeGrowth growth;  // of places added from now on
};

namespace ductile::c {

/// Keeps the text for ductile_last_error(), or a shorter one if memory runs out.
void keep_error(const char* text) noexcept;
/// The same for invalid input; options get their names in the C interface.
void keep_wrong_input(const char* text) noexcept;

/// The number with six digits.
std::string number(double value);

/// Throws InputError if the pointer is null.
inline void expect_given(const void* pointer, const char* name) {
  if (pointer == nullptr)
    throw meshadapt::InputError(std::string(name) + ": expected a pointer, found NULL");
}

/// A pointer that must not be null, and its name in messages.
struct Needed {
  const void* pointer;
  const char* name;
};

/// Calls work() if no needed pointer is null, and turns exceptions into a code.
template <class Work>
int guarded(std::initializer_list<Needed> needed, Work&& work) noexcept {
  try {
    for (const auto& [pointer, name] : needed) expect_given(pointer, name);
    work();
    return DUCTILE_OK;
  } catch (const meshadapt::InputError& error) {
    keep_wrong_input(error.what());
    return DUCTILE_WRONG_INPUT;
  } catch (const std::bad_alloc&) {
    keep_error("there is not enough memory");
  } catch (const std::exception& error) {
    keep_error(error.what());
  } catch (...) {
    keep_error("something was thrown that is no std::exception");
  }
  return DUCTILE_FAILED;
}

/// The value of the pair in `table` with this name. Throws InputError, which begins with `what`.
template <class Table>
const auto& named_in(const Table& table, std::string_view name, const std::string& what) {
  std::string names;
  for (const auto& [known, value] : table) {
    if (known == name) return value;
    names += names.empty() ? "" : ", ";
    names += known;
  }
  throw meshadapt::InputError(what + " " + std::string(name) + ": expected one of " + names);
}

/// The given options, or the defaults.
inline const ductile_options& or_defaults(const ductile_options* options) {
  static const ductile_options defaults;
  return options == nullptr ? defaults : *options;
}

/// Throws InputError if the count is below 0, or if the array is null although the count is not 0.
inline void expect_array(const void* array, std::int64_t count, const char* name) {
  if (count < 0)
    throw meshadapt::InputError(std::string(name) + ": expected 0 entries or more, found " +
                                std::to_string(count));
  if (count > 0) expect_given(array, name);
}

/// Throws InputError unless the dimension is 2 or 3.
inline void expect_dimension(int dimension) {
  if (dimension != 2 && dimension != 3)
    throw meshadapt::InputError("dimension: expected 2 or 3, found " + std::to_string(dimension));
}

/// The dimension of this kind of entities in a mesh of dimension `dimension`. Throws InputError if
/// such a mesh has no such entities.
inline int dimension_of(int kind, int dimension) {
  if (kind == DUCTILE_VERTICES) return 0;
  if (kind == DUCTILE_RIDGES && dimension == 3) return 1;
  if (kind == DUCTILE_FACETS) return dimension - 1;
  if (kind == DUCTILE_ELEMENTS) return dimension;
  throw meshadapt::InputError("kind: expected DUCTILE_VERTICES, " +
                              std::string(dimension == 3 ? "DUCTILE_RIDGES, " : "") +
                              "DUCTILE_FACETS or DUCTILE_ELEMENTS, found " + std::to_string(kind));
}

/// Throws unless entities can be counted by the C library's signed indices.
inline void expect_signed(const meshadapt::AnyMesh& mesh) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (mesh.vertex_count() > most || mesh.triangles.size() > most || mesh.tetrahedra.size() > most)
    throw meshadapt::Error("the new mesh has more entities than 31 bits can count");
}

/// Throws InputError unless the sizes are for meshes of the mesh's dimension.
inline void expect_dimension_of(const ductile_sizes& sizes, const ductile_mesh& mesh) {
  if (sizes.dimension != mesh.mesh.dimension)
    throw meshadapt::InputError("sizes: expected those for meshes of dimension " +
                                std::to_string(mesh.mesh.dimension) + ", found dimension " +
                                std::to_string(sizes.dimension));
}

}  // namespace ductile::c
