/// @file
/// TextSink and BinarySink: take the sections of a GMF file number by number, as the two cursors
/// give them. Sizes of records are known in advance, so a binary file is written in one go, with
/// its links to the next section right from the start.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <type_traits>

#include "ductile/meshadapt/files.hpp"
#include "gmf_place.hpp"
#include "io/atomic_file.hpp"

namespace ductile::meshadapt::gmf {

/// Thread safety: one thread.
class TextSink {
 public:
  TextSink(OutputFile& out, int version);

  void dimension(int dimension);
  /// A section's head; `head_numbers` small integers follow it before the records.
  void section(const Place& section, std::size_t head_numbers = 0);
  void head_number(int number);
  void end_of_head();
  void end_of_file();

  // ---- Records ----
  void begin_record(const Place& section) { at_ = out_.room(section.shape.numbers() * widest + 1); }
  void real(double value) { put(value); }
  void integer(std::int64_t value) { put(value); }
  void end_record() {
    at_[-1] = '\n';
    out_.advance_to(at_);
  }

 private:
  static constexpr std::size_t widest = 26;  ///< the longest double, a space, and one to spare

  template <class Number>
  void put(Number value) {
    at_ = std::to_chars(at_, at_ + widest, value).ptr;
    *at_++ = ' ';
  }

  OutputFile& out_;
  char* at_ = nullptr;
};

/// Sizes of numbers in a binary file of one version.
struct BinarySizes {
  int version = 2;

  std::size_t real() const { return version == 1 ? 4 : 8; }
  std::size_t integer() const { return version == 4 ? 8 : 4; }
  std::size_t position() const { return version >= 3 ? 8 : 4; }
  std::size_t record(Shape shape) const {
    return shape.reals * real() + shape.integers * integer();
  }
  /// Keyword, position of the next section, count, head numbers and records.
  std::size_t section(const Place& section, std::size_t head_numbers) const {
    return 4 + position() + integer() + 4 * head_numbers + section.count * record(section.shape);
  }
  /// First and last bytes: two numbers, the section Dimension, the section End.
  std::size_t frame() const { return 8 + (8 + position()) + (4 + position()); }
};

/// Thread safety: one thread.
class BinarySink {
 public:
  BinarySink(OutputFile& out, int version, std::endian byte_order);

  void dimension(int dimension);
  void section(const Place& section, std::size_t head_numbers = 0);
  void head_number(int number) { value(static_cast<std::int32_t>(number)); }
  void end_of_head() {}
  void end_of_file();

  void begin_record(const Place& section) { at_ = out_.room(sizes_.record(section.shape)); }
  void real(double value) { sizes_.version == 1 ? put(static_cast<float>(value)) : put(value); }
  void integer(std::int64_t value) {
    sizes_.version == 4 ? put(value) : put(static_cast<std::int32_t>(value));
  }
  void end_record() { out_.advance_to(at_); }

 private:
  template <class Number>
  void put(Number number) {
    static_assert(std::is_trivially_copyable_v<Number>);
    unsigned char bytes[sizeof(Number)];
    std::memcpy(bytes, &number, sizeof(Number));
    if (swapped_) std::reverse(std::begin(bytes), std::end(bytes));
    std::memcpy(at_, bytes, sizeof(Number));
    at_ += sizeof(Number);
  }
  /// A number outside records.
  template <class Number>
  void value(Number number) {
    at_ = out_.room(sizeof(Number));
    put(number);
    out_.advance_to(at_);
  }
  void position(std::size_t position);

  OutputFile& out_;
  BinarySizes sizes_;
  bool swapped_;
  char* at_ = nullptr;
};

}  // namespace ductile::meshadapt::gmf
