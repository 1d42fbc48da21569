#include "vtk_decode.hpp"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <new>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

constexpr const char* damaged = "; the file is damaged or cut short, write it again";

constexpr auto value_of_letter = [] {
  std::array<int, 256> value{};
  value.fill(-1);
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < letters.size(); ++i)
    value[static_cast<unsigned char>(letters[i])] = static_cast<int>(i);
  return value;
}();

/// Takes bytes one after the other from raw ones or from base64. VTK pads base64 in between, behind
/// the numbers in front.
class ByteStream {
 public:
  ByteStream(std::string_view encoded, bool base64) : rest_(encoded), base64_(base64) {}

  std::string_view rest() const { return rest_; }
  /// At most that many can follow.
  std::size_t left() const {
    return waiting_.size() + (base64_ ? rest_.size() / 4 * 3 : rest_.size());
  }

  std::string take(std::size_t count) {
    if (count > left()) fail();
    if (!base64_) {
      const std::string_view bytes = rest_.substr(0, count);
      rest_.remove_prefix(count);
      return std::string(bytes);
    }
    std::string bytes = std::move(waiting_);
    bytes.reserve(count + 3);
    while (bytes.size() < count) append_group(bytes);
    waiting_ = bytes.substr(count);
    bytes.resize(count);
    return bytes;
  }

 private:
  [[noreturn]] static void fail() {
    throw InputError(std::string("expected more bytes of an array, found its end") + damaged);
  }

  void append_group(std::string& bytes) {
    std::uint32_t group = 0;
    std::size_t letters = 0, filled = 0, at = 0;
    for (; at < rest_.size() && letters < 4; ++at) {
      const char c = rest_[at];
      if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
      const int value = value_of_letter[static_cast<unsigned char>(c)];
      if (c != '=' && (value < 0 || filled > 0)) fail();
      filled += c == '=';
      group = group << 6U | static_cast<std::uint32_t>(c == '=' ? 0 : value);
      ++letters;
    }
    if (letters < 4 || filled > 2) fail();
    rest_.remove_prefix(at);
    for (std::size_t i = 0; i < 3 - filled; ++i)
      bytes.push_back(static_cast<char>(group >> (16 - 8 * i) & 255U));
  }

  std::string_view rest_;
  std::string waiting_;
  bool base64_;
};

std::uint64_t take_head(ByteStream& bytes, const VtkEncoding& encoding) {
  const std::string head = bytes.take(encoding.head_bytes);
  return encoding.head_bytes == 8 ? loaded<std::uint64_t>(head.data(), encoding.swapped)
                                  : loaded<std::uint32_t>(head.data(), encoding.swapped);
}

void append_block(std::string& to, const std::string& block, std::size_t size) {
  constexpr std::size_t zlib_ratio = 1032;  // the largest that its format allows
  if (size / zlib_ratio > block.size())
    throw InputError("expected fewer bytes than " + std::to_string(size) +
                     " in a compressed block" + damaged);
  const std::size_t start = to.size();
  to.resize(start + size);
  uLongf found = static_cast<uLongf>(size);
  const int result =
      uncompress(reinterpret_cast<Bytef*>(to.data() + start), &found,
                 reinterpret_cast<const Bytef*>(block.data()), static_cast<uLong>(block.size()));
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result != Z_OK || found != size)
    throw InputError(std::string("expected a block that zlib compressed, found other bytes") +
                     damaged);
}

std::string decompressed(ByteStream& bytes, const VtkEncoding& encoding) {
  const std::uint64_t blocks = take_head(bytes, encoding);
  if (blocks == 0) return {};  // VTK writes no sizes then
  const std::uint64_t size = take_head(bytes, encoding), last = take_head(bytes, encoding);
  if (blocks > bytes.left() / encoding.head_bytes)
    throw InputError("expected fewer compressed blocks than " + std::to_string(blocks) + damaged);
  std::vector<std::uint64_t> compressed(static_cast<std::size_t>(blocks));
  for (std::uint64_t& bytes_of_block : compressed) bytes_of_block = take_head(bytes, encoding);
  std::string result;
  for (std::size_t block = 0; block < compressed.size(); ++block) {
    const bool is_partial = block + 1 == compressed.size() && last != 0;
    if (compressed[block] > bytes.left())
      throw InputError(std::string("expected more compressed bytes") + damaged);
    append_block(result, bytes.take(static_cast<std::size_t>(compressed[block])),
                 static_cast<std::size_t>(is_partial ? last : size));
  }
  return result;
}

}  // namespace

VtkDecoded vtk_decoded(std::string_view encoded, bool base64, const VtkEncoding& encoding) {
  ByteStream bytes(encoded, base64);
  VtkDecoded result;
  if (encoding.compressed) {
    result.bytes = decompressed(bytes, encoding);
  } else {
    const std::uint64_t size = take_head(bytes, encoding);
    if (size > bytes.left())
      throw InputError("expected " + std::to_string(size) + " bytes of an array, found fewer" +
                       damaged);
    result.bytes = bytes.take(static_cast<std::size_t>(size));
  }
  result.taken = encoded.size() - bytes.rest().size();
  return result;
}

std::vector<double> vtk_reals(std::string_view bytes, NumberKind kind, bool swapped) {
  return visit_number(kind, [&](auto number) {
    std::vector<double> values(bytes.size() / sizeof number);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] =
          static_cast<double>(loaded<decltype(number)>(bytes.data() + i * sizeof number, swapped));
    return values;
  });
}

std::vector<double> vtk_reals(std::string_view text) {
  std::vector<double> values;
  double value = 0;
  for (NumberReader in(text, ""); !in.peek_word().empty(); values.push_back(value))
    if (!in.take(value))
      throw InputError("expected a number in an array of format ascii, found " +
                       quoted(in.peek_word()) + "; correct it");
  return values;
}

}  // namespace ductile::meshadapt
