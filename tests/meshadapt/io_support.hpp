/// @file
/// Shared by the tests of files: a temporary folder, random meshes and fields, and the text of the
/// error that a call throws.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt::test {

/// A new folder, removed with its contents at destruction.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "ductile-test-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error("cannot make a folder for the test");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline void put_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string get_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The message of the InputError that `call` throws; the test fails if it throws none.
template <class Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
    return {};
  }
  ADD_FAILURE() << "expected an InputError, nothing was thrown";
  return {};
}

/// A finite double of any magnitude, including zeros of both signs and denormals.
inline double random_double(std::mt19937_64& random) {
  for (;;) {
    const auto value = std::bit_cast<double>(random());
    if (random() % 16 == 0) return random() % 2 ? 0.0 : -0.0;
    if (value - value == 0) return value;
  }
}

/// A mesh with entries in every section. Indices are in range; otherwise it need not be valid. With
/// `as_float`, coordinates are floats.
inline AnyMesh random_mesh(int dimension, std::size_t size, unsigned seed, bool as_float = false) {
  std::mt19937_64 random(seed);
  const auto below = [&](std::size_t limit) {
    return static_cast<std::uint32_t>(random() % limit);
  };
  const auto reference = [&] { return static_cast<std::int32_t>(random()); };
  AnyMesh mesh;
  mesh.dimension = dimension;
  for (std::size_t vertex = 0; vertex < size; ++vertex) {
    mesh.vertex_reference.push_back(reference());
    for (int axis = 0; axis < dimension; ++axis)
      mesh.coordinates.push_back(as_float ? static_cast<float>(below(1000)) / 7.0F
                                          : random_double(random));
  }
  for (std::size_t cell = 0; cell < 1 + size / 2; ++cell) {
    mesh.edges.add({below(size), below(size)}, reference());
    mesh.triangles.add({below(size), below(size), below(size)}, reference());
    if (dimension == 3)
      mesh.tetrahedra.add({below(size), below(size), below(size), below(size)}, reference());
  }
  for (std::size_t entry = 0; entry < 1 + size / 5; ++entry) {
    mesh.corners.push_back(below(size));
    mesh.required_vertices.push_back(below(size));
    mesh.ridges.push_back(below(mesh.edges.size()));
    mesh.required_edges.push_back(below(mesh.edges.size()));
    mesh.required_triangles.push_back(below(mesh.triangles.size()));
    if (dimension == 3) mesh.required_tetrahedra.push_back(below(mesh.tetrahedra.size()));
  }
  return mesh;
}

inline AnyField random_field(int dimension, std::size_t size, std::vector<AnyField::Type> types,
                             unsigned seed, bool as_float = false) {
  std::mt19937_64 random(seed);
  AnyField field;
  field.dimension = dimension;
  field.vertex_count = size;
  field.types = std::move(types);
  field.values.resize(size * stride_of(field));
  for (double& value : field.values)
    value = as_float ? static_cast<float>(random() % 1000) / 3.0F : random_double(random);
  return field;
}

}  // namespace ductile::meshadapt::test
