/// @file
/// What stands behind the handles of ductile.h, and how exceptions become codes.
#pragma once

#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "ductile.h"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"

/// A mesh; an adapted one has a metric and a report, too.
struct ductile_mesh {
  ductile::meshadapt::AnyMesh mesh;
  ductile::meshadapt::AnyField metric;
  ductile::meshadapt::AdaptReport report;
};

struct ductile_options {
  ductile::meshadapt::AdaptOptions adapt;
  ductile::runtime::ExecutorOptions executor;
  double elements = 0, norm = 2;  // of the metric of a solution
};

namespace ductile::c {

/// Keeps the text for ductile_last_error(). What does not fit into memory is said in fewer words.
void keep_error(const char* text) noexcept;

/// Calls work() and turns what it throws into a code.
template <class Work>
int guarded(Work&& work) noexcept {
  try {
    work();
    return DUCTILE_OK;
  } catch (const meshadapt::InputError& error) {
    keep_error(error.what());
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

/// Throws InputError if a pointer that must lead somewhere does not.
inline void expect_given(const void* pointer, const char* name) {
  if (pointer == nullptr)
    throw meshadapt::InputError(std::string(name) + ": expected a pointer, found NULL");
}

/// The same of an array of `count` entries, which may be NULL if there are none. Throws InputError
/// for counts below 0, too.
inline void expect_array(const void* array, std::int64_t count, const char* name) {
  if (count < 0)
    throw meshadapt::InputError(std::string(name) + ": expected 0 entries or more, found " +
                                std::to_string(count));
  if (count > 0) expect_given(array, name);
}

}  // namespace ductile::c
