/// @file
/// Arrays that are broken in random ways, and the allowed reactions of a function.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::test {

/// Suites of tests in both dimensions.
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

/// Expects the call to throw an InputError whose message mentions no files or options.
template <class Call>
void expect_refused(const Call& call, const std::string& what) {
  SCOPED_TRACE(what);
  try {
    call();
    ADD_FAILURE() << "expected an InputError, nothing was thrown";
  } catch (const InputError& error) {
    const std::string text = error.what();
    for (const char* word : {"option", " file", "--", " -h", ".mesh:"})
      EXPECT_EQ(text.find(word), std::string::npos) << text;
    EXPECT_NE(text.front(), ':') << text;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
}

/// Expects that the call returns or throws an InputError.
template <class Call>
void expect_survived(const Call& call, const std::string& what) {
  SCOPED_TRACE(what);
  try {
    call();
  } catch (const InputError&) {
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
}

template <int Dim>
AnyMesh small_mesh() {
  AnyMesh mesh = make_grid(unit_grid(Dim, 2));
  if constexpr (Dim == 3) list_ridges(mesh);
  mesh.name.clear();
  return mesh;
}

inline void change_length(Random& random, auto& array) {
  if (chance(random, 0.3))
    array.clear();
  else if (chance(random, 0.5))
    array.resize(below(random, array.size()));
  else
    array.resize(array.size() + 1 + below(random, 5));
}

inline double no_number(Random& random) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double values[] = {std::numeric_limits<double>::quiet_NaN(), inf, -inf};
  return values[below(random, 3)];
}

inline std::uint32_t bad_index(Random& random, std::size_t limit) {
  const std::uint32_t values[] = {none, static_cast<std::uint32_t>(limit), 1U << 31U,
                                  static_cast<std::uint32_t>(limit + below(random, 1000))};
  return values[below(random, 4)];
}

template <int Dim>
Metric<Dim> no_metric(Random& random) {
  std::array<double, Dim> sizes;
  for (double& size : sizes) size = uniform(random, 0.1, 1);
  PrincipalAxes<Dim> axes = principal_axes(random_metric<Dim>(random, sizes));
  switch (below(random, 5)) {
    case 0:
      return {};
    case 1:
      axes.value.fill(-1);
      break;
    case 2:
      axes.value[0] *= -1;
      break;
    case 3: {  // along the axes of space, because rounding would change it otherwise
      Metric<Dim> stretched = isotropic<Dim>(1);
      stretched.m[0] = 1e-20;
      stretched.m[2] = 1e20;
      return stretched;
    }
    default:
      axes.value[Dim - 1] = -1e-3 * axes.value[0];
      break;
  }
  return compose(axes);
}

/// A folder for the running test, removed afterwards.
struct Folder {
  std::filesystem::path path;
  Folder() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    std::string name = test.test_suite_name() + std::string("_") + test.name();
    std::ranges::replace(name, '/', '_');
    path = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
};

}  // namespace ductile::meshadapt::test
