/// @file
/// OutputFile: where one of several outputs goes that appear together; see AtomicOutputs.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/process.hpp"

namespace ductile::meshadapt {

/// Where one output goes, buffered. Every write is checked.
/// Thread safety: one thread.
class OutputFile {
 public:
  /// Use AtomicOutputs::stage. Opens a file that is to be at `path`, which errors name.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends bytes. Throws Error when the system takes no more (disk full, quota, size limit).
  void write(std::string_view bytes);

  /// Where the next byte goes, with room for `size` bytes (at most `buffer_size`) behind it: put
  /// them there, then call `advance_to` with their end. Throws Error as write does.
  char* room(std::size_t size) {
    if (buffer_size - used_ < size) flush();
    return buffer_.get() + used_;
  }
  void advance_to(const char* end) { used_ = static_cast<std::size_t>(end - buffer_.get()); }

  /// Bytes appended so far.
  std::size_t size() const { return flushed_ + used_; }

  static constexpr std::size_t buffer_size = std::size_t{1} << 18;

 private:
  friend class AtomicOutputs;
  void flush();
  void finish();  ///< brings all of it to disk, or to whoever reads it
  void close();   ///< gives it a temporary name, if it has none
  template <class Take>
  void take_temporary_name(const Take& take);
  void discard() noexcept;
  [[noreturn]] void fail(const char* action) const;
  bool writes_directly() const { return temporary_ == path_; }

  std::filesystem::path path_;
  std::filesystem::path temporary_;                  ///< empty while the file has no name
  std::optional<runtime::VanishingFile> vanishing_;  ///< of that name
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  std::size_t flushed_ = 0;
  std::FILE* file_ = nullptr;
  bool broken_ = false;  ///< a write failed, so what follows has a gap
  bool done_ = false;
};

}  // namespace ductile::meshadapt
