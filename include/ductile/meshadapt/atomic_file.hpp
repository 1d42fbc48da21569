/// @file
/// AtomicOutputs: output files that appear whole or not at all. Each one has no name while it is
/// written, or, where the file system has no such files, a temporary one beside its place,
/// `NAME.ductile-tmp-PID-N`; commit() gives all of them their names when every byte of every one is
/// on disk. Until then, and after an error or an interrupt, the files that were there before are
/// untouched. Signals that end the process remove temporary files, and wait while names are given
/// (runtime/process.hpp). What is no regular file (/dev/null, a pipe) is written directly, and
/// so is what a name such as /dev/stdout or /dev/fd/3 stands for, where it is a regular file, too.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Several outputs that belong together.
/// Thread safety: one thread.
class AtomicOutputs {
 public:
  AtomicOutputs();
  /// Removes the temporaries of what was not committed.
  ~AtomicOutputs();
  AtomicOutputs(const AtomicOutputs&) = delete;
  AtomicOutputs& operator=(const AtomicOutputs&) = delete;

  /// Opens an output for `path`, valid until commit(). A symbolic link is followed: the file that
  /// it names is replaced. Throws InputError where check_writable would, or when `path` is staged.
  OutputFile& stage(const std::filesystem::path& path);

  /// Brings every file to disk, then moves each to its place. The old files of all but the first
  /// that was staged are set aside before: a process that is killed meanwhile may leave the first
  /// one, old or new, without the others, but never old ones beside new ones. Throws Error: if a
  /// file could not be written to its end, or a rename fails, the old files are in place, except
  /// where the text names what new ones are.
  void commit();

 private:
  std::vector<std::unique_ptr<OutputFile>> files_;
};

/// The files beside `path` that hold what it held or was to hold, because a process that wrote it
/// was killed.
std::vector<std::filesystem::path> left_of(const std::filesystem::path& path);

/// Whether a file could be written at `path`, to be asked before long work: throws InputError if
/// the path is empty or a folder, or if its folder is missing or refuses a new file.
void check_writable(const std::filesystem::path& path);

/// The same of outputs that belong together, of which no two may be one file.
void check_writable(const std::vector<std::filesystem::path>& paths);

}  // namespace ductile::meshadapt
