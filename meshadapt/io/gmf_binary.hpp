/// @file
/// BinaryCursor: goes through the bytes of a binary GMF file number by number. The file is a chain
/// of sections: keyword, position of the next keyword, count, records. The version sets the sizes:
/// reals 4 bytes in 1, else 8; positions 8 bytes from 3 on; counts and integers 8 bytes in 4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "file_bytes.hpp"
#include "gmf_place.hpp"

namespace ductile::meshadapt::gmf {

/// Thread safety: one thread; several cursors may go through the same bytes.
class BinaryCursor {
 public:
  /// Whether the bytes begin as a binary file does, in either byte order.
  static bool recognises(const FileBytes& bytes);

  /// Takes the version; throws InputError for an unknown one. `bytes` must outlive the cursor.
  explicit BinaryCursor(const FileBytes& bytes);

  // ---- Numbers: the caller has made sure of their bytes by enter_records ----
  std::int64_t integer() { return wide_ ? load<std::int64_t>() : load<std::int32_t>(); }
  double real() { return single_ ? static_cast<double>(load<float>()) : load<double>(); }
  double real_or_infinite() { return real(); }
  /// Numbers in a section's head; throw InputError at the end of the file.
  std::int64_t small_integer();
  std::int64_t count();

  // ---- Sections ----
  /// Goes to the next section; none after the last one, and none after a link of 0, as
  /// some programs end a file without End. Throws InputError for a link that leads
  /// outside, backwards or into the section itself.
  Keyword next_section();
  bool chain_ended_without_end() const { return !ended_ && next_ == 0; }
  std::size_t bytes_after_end() const;
  int code() const { return code_; }
  std::size_t section_bytes() const { return section_end() - at_; }
  void enter(Keyword keyword, std::uint64_t count) { section_ = {keyword, count, 0, {}}; }
  /// As AsciiCursor's.
  Place enter_records(Shape shape);
  void record(std::size_t number) { record_ = number; }
  /// Throws InputError unless the section ends here.
  void leave() const;

  // ---- Messages ----
  [[noreturn]] void fail(const std::string& text) const { fail_at(at_, text); }
  [[noreturn]] void fail_number(const std::string& expected, const std::string& found) const;
  [[noreturn]] void fail_in(const Place& place, std::size_t record, int field,
                            const std::string& text) const;
  std::string where() const { return where(at_); }

 private:
  template <class Number>
  Number load();
  std::size_t section_end() const { return next_ == 0 ? size_ : next_; }
  std::size_t record_bytes(Shape shape) const {
    return shape.reals * (single_ ? 4 : 8) + shape.integers * (wide_ ? 8 : 4);
  }
  void expect_bytes(std::size_t bytes, const char* what) const;
  std::string where(std::size_t at) const;
  [[noreturn]] void fail_at(std::size_t at, const std::string& text) const;

  const char* begin_;
  std::size_t size_;
  std::size_t at_ = 0;
  std::size_t next_ = 8;  ///< where the next section begins; 0: there is none
  bool ended_ = false;
  bool swapped_ = false;
  bool single_ = false;
  bool wide_ = false;
  bool far_ = false;  ///< positions have 8 bytes
  int code_ = 0;
  std::size_t record_ = 0;
  Place section_;
  std::string_view name_;
};

template <class Number>
Number BinaryCursor::load() {
  unsigned char bytes[sizeof(Number)];
  std::memcpy(bytes, begin_ + at_, sizeof(Number));
  at_ += sizeof(Number);
  if (swapped_) {
    unsigned char reversed[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof(Number); ++i) reversed[i] = bytes[sizeof(Number) - 1 - i];
    std::memcpy(bytes, reversed, sizeof(Number));
  }
  Number value;
  std::memcpy(&value, bytes, sizeof(Number));
  return value;
}

}  // namespace ductile::meshadapt::gmf
