#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "io/give_names.hpp"
#include "io/output_place.hpp"

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

std::string reason(int code) { return std::generic_category().message(code); }

/// Whether a file may have so many bytes. A process that writes more is ended.
bool may_have(std::size_t bytes) {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
         bytes <= limit.rlim_cur;
}

constexpr int most_links = 40;

/// Where a symbolic link leads, if `path` is one.
std::optional<fs::path> target_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return std::nullopt;
  const fs::path target = fs::read_symlink(path, error);
  if (error) return std::nullopt;
  return target.is_absolute() ? target : folder_of(path) / target;
}

/// The file that a chain of symbolic links ends in, which need not exist.
fs::path resolve_links(fs::path path) {
  for (int step = 0; step < most_links; ++step) {
    auto target = target_of(path);
    if (!target) break;
    path = *std::move(target);
  }
  return path;
}

bool lists_descriptors(const fs::path& folder) {
  std::error_code error;
  const fs::path place = fs::canonical(folder, error);
  if (error) return false;
  return place == fs::canonical("/dev/fd", error) || place == fs::canonical("/proc/self/fd", error);
}

/// What is open under a name that stands for it, as /dev/stdout and /proc/self/fd/3 do. Such a name
/// may lead on to a regular file, which others write, too.
std::optional<int> descriptor_of(fs::path path) {
  for (int step = 0; step < most_links; ++step) {
    const std::string name = path.filename().string();
    int number = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number >= 0 &&
        lists_descriptors(folder_of(path)))
      return ::fcntl(number, F_GETFL) < 0 ? std::nullopt : std::optional(number);
    auto target = target_of(path);
    if (!target) break;
    path = *std::move(target);
  }
  return std::nullopt;
}

/// Devices and pipes: there is no old content to keep, and nothing may take their name.
bool is_device(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool is_written_directly(const fs::path& path) {
  return is_device(path) || descriptor_of(path).has_value();
}

/// What to write for an output. What is written directly stays as it is: what /dev/stdout leads to,
/// as "pipe:[123]", is no name that could be opened.
fs::path file_of(const fs::path& path) {
  return is_written_directly(path) ? path : resolve_links(path);
}

/// The same for all names of one file, which need not exist yet.
fs::path place_of(const fs::path& path) {
  const fs::path file = file_of(path);
  std::error_code error;
  const fs::path folder = fs::canonical(folder_of(file), error);
  return error ? file : folder / file.filename();
}

[[noreturn]] void complain_of_two_outputs(const fs::path& path) {
  throw InputError(path.string() + ": is the name of two outputs; give each its own");
}

void expect_usable_name(const fs::path& path) {
  if (path.empty()) throw InputError("expected the name of an output file, found an empty one");
  expect_name_to_lead_somewhere(path);
  std::error_code error;
  const std::string name = path.string();
  if (!path.has_filename() || fs::is_directory(path, error))
    throw InputError(name + ": expected a file to write, found a folder; add a file name");
  if (!fs::is_directory(folder_of(path), error))
    throw InputError(name + ": cannot write, there is no folder " + folder_of(path).string() +
                     "; create it first");
  if (const auto descriptor = descriptor_of(path)) {
    if ((::fcntl(*descriptor, F_GETFL) & O_ACCMODE) == O_RDONLY)
      throw InputError(name + ": cannot write, it is open for reading only; choose another name");
    return;
  }
  if (fs::exists(path, error) && ::access(path.c_str(), W_OK) != 0)
    throw InputError(name + ": cannot write, " + reason(errno) +
                     "; change its permissions or choose another name");
  if (!is_device(path)) expect_replaceable(resolve_links(path));
}

fs::path create_temporary(const fs::path& path) {
  return create_beside(path, "tmp", [](const fs::path& name) {
    std::FILE* const file = std::fopen(name.c_str(), "wbx");
    return file != nullptr && std::fclose(file) == 0;
  });
}

/// Where the system has a name for what is open.
std::string name_of_descriptor(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

/// A file without a name, of which nothing is left if the process ends; null where there is no such
/// thing, or none that could get a name.
std::FILE* open_unnamed([[maybe_unused]] const fs::path& folder) {
#ifdef O_TMPFILE
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) return nullptr;
  if (::access(name_of_descriptor(descriptor).c_str(), F_OK) == 0)
    if (std::FILE* const file = ::fdopen(descriptor, "wb")) return file;
  ::close(descriptor);
#endif
  return nullptr;
}

/// Opened anew, a regular file would lose what is in it, and a socket could not be.
std::FILE* open_directly(const fs::path& path) {
  const auto descriptor = descriptor_of(path);
  if (!descriptor) return std::fopen(path.c_str(), "wb");
  const int copy = ::fcntl(*descriptor, F_DUPFD_CLOEXEC, 0);
  if (copy < 0) return nullptr;
  std::FILE* const file = ::fdopen(copy, "wb");
  if (!file) ::close(copy);
  return file;
}

}  // namespace

// ---- One file ----

OutputFile::OutputFile(fs::path path)
    : path_(std::move(path)), buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)) {
  if (is_written_directly(path_))
    temporary_ = path_;
  else if (file_ = open_unnamed(folder_of(path_)); !file_)
    take_temporary_name([&] { return create_temporary(path_); });
  if (!file_) file_ = open_directly(temporary_);
  if (!file_) {
    const int code = errno;
    discard();
    if (code == ENOMEM) throw std::bad_alloc();
    const std::string why = reason(code);
    throw InputError(path_.string() + ": cannot write, " + why + "; choose another folder");
  }
  std::setvbuf(file_, nullptr, _IONBF, 0);
  std::error_code ignored;  // keeping the old file's permissions is a courtesy
  const fs::file_status old = fs::status(path_, ignored);
  if (!writes_directly() && fs::exists(old))
    (void)::fchmod(::fileno(file_), static_cast<mode_t>(old.permissions()));
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::fail(const char* action) const {
  const int code = errno;
  if (code == ENOMEM) throw std::bad_alloc();
  throw Error(path_.string() + ": cannot " + action + ", " + reason(code) + " after " +
              std::to_string(flushed_) + " bytes; " +
              (code == EFBIG ? "raise the limit of file sizes (ulimit -f)"
                             : "free disk space or choose another folder"));
}

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    if (used_ == buffer_size) flush();
    const std::size_t part = std::min(bytes.size(), buffer_size - used_);
    std::memcpy(buffer_.get() + used_, bytes.data(), part);
    used_ += part;
    bytes.remove_prefix(part);
  }
}

void OutputFile::flush() {
  if (used_ == 0) return;
  const bool may_grow = writes_directly() || may_have(flushed_ + used_);
  errno = may_grow ? 0 : EFBIG;
  const std::size_t written = may_grow ? std::fwrite(buffer_.get(), 1, used_, file_) : 0;
  flushed_ += written;
  broken_ = broken_ || written != std::exchange(used_, 0);
  if (broken_) fail("write");
}

void OutputFile::finish() {
  if (!file_) return;
  if (broken_) fail("finish");
  flush();
  if (!writes_directly()) {
    if (!bring_to_disk(::fileno(file_))) fail("bring to disk");
    return;
  }
  errno = 0;
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("close");
}

template <class Take>
void OutputFile::take_temporary_name(const Take& take) {
  const runtime::HeldSignals held;
  temporary_ = take();
  vanishing_.emplace(temporary_.c_str());
}

void OutputFile::close() {
  if (writes_directly()) return;
  if (temporary_.empty())
    take_temporary_name([&] {
      const std::string open = name_of_descriptor(::fileno(file_));
      return create_beside(path_, "tmp", [&](const fs::path& name) {
        return ::linkat(AT_FDCWD, open.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
      });
    });
  errno = 0;
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("close");
}

void OutputFile::discard() noexcept {
  if (file_) std::fclose(std::exchange(file_, nullptr));
  std::error_code ignored;
  if (!done_ && !writes_directly() && !temporary_.empty()) fs::remove(temporary_, ignored);
  vanishing_.reset();
}

// ---- Several files ----

AtomicOutputs::AtomicOutputs() = default;
AtomicOutputs::~AtomicOutputs() = default;

OutputFile& AtomicOutputs::stage(const fs::path& path) {
  expect_usable_name(path);
  const fs::path place = place_of(path);
  for (const auto& file : files_)
    if (place_of(file->path_) == place) complain_of_two_outputs(path);
  files_.push_back(std::make_unique<OutputFile>(file_of(path)));
  return *files_.back();
}

void AtomicOutputs::commit() {
  for (const auto& file : files_) file->finish();
  const runtime::HeldSignals held;
  std::vector<CompleteFile> unit;
  for (const auto& file : files_) {
    file->close();
    if (!file->writes_directly()) unit.push_back({file->temporary_, file->path_});
  }
  give_names(unit);
  for (const auto& file : files_) file->done_ = true;
  files_.clear();
}

void check_writable(const fs::path& path) {
  expect_usable_name(path);
  if (is_written_directly(path)) return;
  const fs::path target = resolve_links(path);
  std::error_code ignored;
  const runtime::HeldSignals held;
  fs::remove(create_temporary(target), ignored);
}

void check_writable(const std::vector<fs::path>& paths) {
  std::vector<fs::path> places;
  for (const fs::path& path : paths) {
    check_writable(path);
    places.push_back(place_of(path));
    if (std::count(places.begin(), places.end(), places.back()) > 1) complain_of_two_outputs(path);
  }
}

void write_bytes(AtomicOutputs& outputs, const fs::path& path, std::string_view bytes) {
  outputs.stage(path).write(bytes);
}

}  // namespace ductile::meshadapt
