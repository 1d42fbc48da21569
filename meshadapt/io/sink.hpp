/// @file
/// Sink: takes the bytes of one file, buffered: text, and numbers as text or as bytes in either
/// byte order. All writers of files use it. Every write is checked.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <type_traits>

namespace ductile::meshadapt {

/// Thread safety: one thread.
class Sink {
 public:
  static constexpr std::size_t buffer_size = std::size_t{1} << 18;

  /// Writes to `file`, which stays open; errors name `path`. With `is_limited`, the file may not
  /// outgrow the limit of the process, which would be ended otherwise.
  Sink(std::FILE* file, std::filesystem::path path, bool is_limited);
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  /// Appends bytes. This and all that appends throws Error when the system takes no more (disk
  /// full, quota, size limit).
  void write(std::string_view bytes);

  // ---- Numbers ----
  /// Numbers are text from here on, with spaces between them; `record_end` follows a record.
  void set_text(const char* record_end) {
    binary_ = false;
    record_end_ = record_end;
  }
  void set_binary(std::endian byte_order) {
    binary_ = true;
    swapped_ = byte_order != std::endian::native;
  }
  bool is_binary() const { return binary_; }
  /// Puts numbers, and all those of ranges.
  template <class... Items>
  void put(const Items&... items) {
    (put_item(items), ...);
  }
  template <class... Items>
  void record(const Items&... items) {
    put(items...);
    end_record();
  }
  void end_record() {
    if (!binary_) write(record_end_);
    follows_ = false;
  }

  // ---- The whole ----
  /// Bytes appended so far.
  std::size_t size() const { return flushed_ + used_; }
  /// Hands all bytes to the system. Throws Error if it has refused any.
  void flush();
  /// Throws Error about a system call on the file that failed: "cannot ACTION", and why in errno.
  [[noreturn]] void fail(const char* action) const;

 private:
  template <class Item>
  void put_item(const Item& item) {
    if constexpr (std::is_arithmetic_v<Item>)
      put_number(item);
    else
      for (const auto& number : item) put_number(number);
  }
  template <class Number>
  void put_number(Number number);
  char* room(std::size_t size) {
    if (buffer_size - used_ < size) flush();
    return buffer_.get() + used_;
  }
  void advance_to(const char* end) { used_ = static_cast<std::size_t>(end - buffer_.get()); }

  std::FILE* file_;
  std::filesystem::path path_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  std::size_t flushed_ = 0;
  bool is_limited_;
  int error_ = 0;  ///< errno of a write that failed, so that what follows has a gap
  bool binary_ = false, swapped_ = false;
  const char* record_end_ = " \n";
  bool follows_ = false;  ///< a number of this record, so that a space goes first
};

template <class Number>
void Sink::put_number(Number number) {
  constexpr std::size_t widest = 32;
  char* at = room(widest);
  if (binary_) {
    std::memcpy(at, &number, sizeof(Number));
    if (swapped_) std::reverse(at, at + sizeof(Number));
    return advance_to(at + sizeof(Number));
  }
  if (follows_) *at++ = ' ';
  follows_ = true;
  advance_to(std::to_chars(at, at + widest - 1, +number).ptr);  // a letter as its number
}

}  // namespace ductile::meshadapt
