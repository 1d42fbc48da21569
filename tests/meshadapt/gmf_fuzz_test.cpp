// Thousands of damaged files: each is read, or refused by an InputError, and no allocation is large
// compared to the file. Meant for the address and undefined-behaviour sanitizers.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "io_support.hpp"

namespace {

std::size_t largest_request = 0;

void* memory_or_null(std::size_t size) {
  largest_request = std::max(largest_request, size);
  return std::malloc(size ? size : 1);
}

[[maybe_unused]] void* allocate(std::size_t size) {
  if (void* memory = memory_or_null(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// Clang's thread sanitizer replaces operator new itself, so requests cannot be observed there.
#if defined(__clang__) && defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define DUCTILE_REQUESTS_UNSEEN
#endif
#endif
#ifndef DUCTILE_REQUESTS_UNSEEN
void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
// std::stable_sort requests memory by this operator.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return memory_or_null(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace ductile::meshadapt::gmf_fuzz_test {
namespace {

using Form = WriteOptions::Form;
using Type = AnyField::Type;

/// Changes, removes or doubles a few bytes, or cuts the end off.
std::string damaged(std::string bytes, bool is_text, std::mt19937_64& random) {
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
  const std::string likely = "0123456789 -+.eE\n#nEx";
  for (std::size_t change = 0; change < 1 + below(3); ++change) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(20);
    switch (below(is_text ? 5 : 4)) {
      case 0:
        bytes.resize(at + 1);
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
        break;
      case 3:
        if (at + length < bytes.size()) bytes.erase(at, length);
        break;
      default:
        bytes[at] = likely[below(likely.size())];
    }
  }
  return bytes;
}

struct Tally {
  int accepted = 0;
  int refused = 0;
};

/// Calls read(path) for damaged copies of the bytes of `good`.
template <class Read>
Tally read_damaged(const std::string& good, bool is_text, const Read& read) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "damaged";
  std::mt19937_64 random(1);
  Tally tally;
  for (int trial = 0; trial < 600; ++trial) {
    const std::string bytes = damaged(good, is_text, random);
    test::put_bytes(path, bytes);
    largest_request = 0;
    try {
      read(path);
      ++tally.accepted;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with(path.string())) << error.what();
      ++tally.refused;
    }
    EXPECT_LE(largest_request, 4096 + 8 * bytes.size());
  }
  return tally;
}

TEST(GmfFuzz, DamagedMeshesAreReadOrRefused) {
  const test::TemporaryFolder folder;
  for (const int version : {1, 2, 3, 4})
    for (const Form form : {Form::ascii, Form::binary})
      for (const int dimension : {2, 3}) {
        write_mesh(folder / "good", test::random_mesh(dimension, 9, 3, true),
                   {.version = version, .form = form});
        const std::string good = test::get_bytes(folder / "good");
        const Tally tally = read_damaged(good, form == Form::ascii, [](const auto& path) {
          Warnings warnings;
          const AnyMesh mesh = read_mesh(path, &warnings);
          for (const auto& triangle : mesh.triangles.vertices)
            for (const std::uint32_t vertex : triangle) EXPECT_LT(vertex, mesh.vertex_count());
        });
        EXPECT_GT(tally.refused, 200);
        EXPECT_GT(tally.accepted, 5);
      }
}

TEST(GmfFuzz, DamagedFieldsAreReadOrRefused) {
  const test::TemporaryFolder folder;
  for (const int version : {1, 2, 4})
    for (const Form form : {Form::ascii, Form::binary}) {
      const AnyField field = test::random_field(3, 7, {Type::symmetric, Type::scalar}, 3, true);
      write_field(folder / "good", field, {.version = version, .form = form});
      const std::string good = test::get_bytes(folder / "good");
      const Tally tally = read_damaged(good, form == Form::ascii, [](const auto& path) {
        Warnings warnings;
        const AnyField back = read_field(path, &warnings);
        EXPECT_EQ(back.values.size(), back.vertex_count * stride_of(back));
      });
      EXPECT_GT(tally.refused, 200);
      EXPECT_GT(tally.accepted, 5);
    }
}

TEST(GmfFuzz, RandomBytesAreRefused) {
  for (const std::string& start : {std::string(), std::string("\1\0\0\0\2\0\0\0", 8),
                                   std::string("MeshVersionFormatted 2\nDimension 3\nVertices ")}) {
    const test::TemporaryFolder folder;
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 500; ++trial) {
      std::string bytes = start;
      for (std::size_t i = 0; i < 1 + random() % 200; ++i)
        bytes.push_back(static_cast<char>(random()));
      test::put_bytes(folder / "noise", bytes);
      largest_request = 0;
      EXPECT_THROW(read_mesh(folder / "noise"), InputError);
      EXPECT_LE(largest_request, 4096 + 8 * bytes.size());
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::gmf_fuzz_test
