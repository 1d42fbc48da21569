#include "vtk_array.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 20;

void append_base64(std::string& text, std::span<const unsigned char> bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t start = text.size();
  text.resize(start + (bytes.size() + 2) / 3 * 4, '=');
  char* out = text.data() + start;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k <= count; ++k) out[k] = letters[group >> (18 - 6 * k) & 63U];
    out += 4;
  }
}

/// Appends one compressed block and returns its size.
std::uint64_t append_compressed(std::vector<unsigned char>& bytes,
                                std::span<const std::byte> block) {
  const std::size_t start = bytes.size();
  uLongf size = compressBound(static_cast<uLong>(block.size()));
  bytes.resize(start + size);
  const int result =
      compress2(bytes.data() + start, &size, reinterpret_cast<const Bytef*>(block.data()),
                static_cast<uLong>(block.size()), Z_BEST_SPEED);
  if (result != Z_OK) throw Error("zlib cannot compress an array, probably for want of memory");
  bytes.resize(start + size);
  return size;
}

}  // namespace

std::string vtk_encoded(std::span<const std::byte> array) {
  // The table: blocks, bytes of a block, bytes of the last one if it is shorter, compressed sizes.
  std::vector<std::uint64_t> table = {(array.size() + block_size - 1) / block_size, block_size,
                                      array.size() % block_size};
  std::vector<unsigned char> compressed;
  for (std::size_t begin = 0; begin < array.size(); begin += block_size)
    table.push_back(append_compressed(
        compressed, array.subspan(begin, std::min(block_size, array.size() - begin))));
  std::string text;
  append_base64(text, {reinterpret_cast<const unsigned char*>(table.data()), 8 * table.size()});
  append_base64(text, compressed);
  return text;
}

}  // namespace ductile::meshadapt
