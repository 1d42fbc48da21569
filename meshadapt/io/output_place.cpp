#include "output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/process.hpp"
#include "number_in.hpp"

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

std::string reason(int code) { return std::generic_category().message(code); }

[[noreturn]] void refuse(const fs::path& path, const std::string& why, const std::string& advice) {
  throw InputError(path.string() + ": cannot write, " + why + "; " + advice);
}

// ---- Where a name leads ----

constexpr int most_links = 40;

/// The target of a symbolic link, if `path` is one.
std::optional<fs::path> target_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return std::nullopt;
  const fs::path target = fs::read_symlink(path, error);
  if (error) return std::nullopt;
  return target.is_absolute() ? target : folder_of(path) / target;
}

bool lists_descriptors(const fs::path& folder) {
  std::error_code error;
  const fs::path place = fs::canonical(folder, error);
  if (error) return false;
  return place == fs::canonical("/dev/fd", error) || place == fs::canonical("/proc/self/fd", error);
}

/// The open descriptor that a name stands for, as /dev/stdout and /proc/self/fd/3 do. Such a name
/// may lead on to a regular file, which others write, too.
std::optional<int> descriptor_of(fs::path path) {
  for (int step = 0; step < most_links; ++step) {
    const auto number = number_in<int>(path.filename().string());
    if (number && *number >= 0 && lists_descriptors(folder_of(path)))
      return ::fcntl(*number, F_GETFL) < 0 ? std::nullopt : number;
    auto target = target_of(path);
    if (!target) break;
    path = *std::move(target);
  }
  return std::nullopt;
}

/// Devices and pipes: there is no old content to keep.
bool is_device(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// ---- Whether a file may be put there ----

bool is_mount_point([[maybe_unused]] const fs::path& path) {
#ifdef STATX_ATTR_MOUNT_ROOT
  struct statx status {};
  return ::statx(AT_FDCWD, path.c_str(), 0, STATX_BASIC_STATS, &status) == 0 &&
         (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
#else
  return false;
#endif
}

/// In a sticky folder such as /tmp, only the owner of a file or of the folder may remove a name.
bool is_others_in_sticky_folder(const struct stat& file, const fs::path& folder) {
  struct stat of_folder {};
  if (::geteuid() == 0 || ::stat(folder.c_str(), &of_folder) != 0) return false;
  return (of_folder.st_mode & S_ISVTX) != 0 && of_folder.st_uid != ::geteuid() &&
         file.st_uid != ::geteuid();
}

void expect_name_to_lead_somewhere(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return;
  if (errno == ENAMETOOLONG)
    refuse(path, "the name is longer than the system takes", "choose a shorter one");
  if (errno == ELOOP)
    refuse(path, "the name is a link that leads to itself, or to one that does",
           "remove the link or choose another name");
}

/// Refuses what another file may not replace although a file can be made beside it; found before
/// the work, not when the finished file is to be put there. `path` is no link.
void expect_replaceable(const fs::path& path) {
  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0 || !S_ISREG(file.st_mode)) return;
  if (is_others_in_sticky_folder(file, folder_of(path)))
    refuse(path, "only its owner may replace it in folder " + folder_of(path).string(),
           "choose another name or folder");
  if (is_mount_point(path))
    refuse(path, "it is mounted there and cannot be replaced", "choose another name or folder");
}

/// The common part of temporary names. A long name is cut, to leave room for the rest.
std::string stem_of(const fs::path& path) {
  return path.filename().string().substr(0, 200) + ".ductile-";
}

}  // namespace

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool is_written_directly(const fs::path& path) {
  return is_device(path) || descriptor_of(path).has_value();
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

fs::path file_of(const fs::path& path) {
  if (is_written_directly(path)) return path;  // its end, such as "pipe:[123]", cannot be opened
  fs::path file = path;
  for (int step = 0; step < most_links; ++step) {
    auto target = target_of(file);
    if (!target) break;
    file = *std::move(target);
  }
  return file;
}

fs::path place_of(const fs::path& path) {
  const fs::path file = file_of(path);
  std::error_code error;
  const fs::path folder = fs::canonical(folder_of(file), error);
  return error ? file : folder / file.filename();
}

void expect_usable_name(const fs::path& path) {
  if (path.empty()) throw InputError("expected the name of an output file, found an empty one");
  expect_name_to_lead_somewhere(path);
  std::error_code error;
  const std::string name = path.string();
  if (!path.has_filename() || fs::is_directory(path, error))
    throw InputError(name + ": expected a file to write, found a folder; add a file name");
  if (!fs::is_directory(folder_of(path), error))
    refuse(path, "there is no folder " + folder_of(path).string(), "create it first");
  if (const auto descriptor = descriptor_of(path)) {
    if ((::fcntl(*descriptor, F_GETFL) & O_ACCMODE) == O_RDONLY)
      refuse(path, "it is open for reading only", "choose another name");
    return;
  }
  if (fs::exists(path, error) && ::access(path.c_str(), W_OK) != 0)
    refuse(path, reason(errno), "change its permissions or choose another name");
  if (!is_device(path)) expect_replaceable(file_of(path));
}

void refuse_second_output(const fs::path& path) {
  throw InputError(path.string() + ": is the name of two outputs; give each its own");
}

fs::path create_beside(const fs::path& path, const char* kind) {
  const std::string stem = stem_of(path) + kind + "-" + std::to_string(::getpid()) + "-";
  for (int number = 0;; ++number) {
    fs::path name = folder_of(path) / (stem + std::to_string(number));
    std::FILE* const file = std::fopen(name.c_str(), "wbx");  // no two writers share one
    if (file != nullptr && std::fclose(file) == 0) return name;
    const int code = errno;
    if (code == ENOMEM) throw std::bad_alloc();
    if (code != EEXIST || number > 10000)
      throw InputError(path.string() + ": cannot create a file in folder " +
                       folder_of(path).string() + ", " + reason(code) + "; choose another folder");
  }
}

// ---- Public ----

std::vector<fs::path> left_of(const fs::path& path) {
  std::vector<fs::path> left;
  const std::string stem = stem_of(path);
  std::error_code error;
  for (fs::directory_iterator file(folder_of(path), error), end; !error && file != end;
       file.increment(error))
    if (file->path().filename().string().starts_with(stem)) left.push_back(file->path());
  return left;
}

void check_writable(const fs::path& path) {
  expect_usable_name(path);
  if (is_written_directly(path)) return;
  std::error_code error;
  const runtime::HeldSignals held;
  if (!fs::remove(create_beside(file_of(path), "tmp"), error))
    refuse(path, "no name may be changed in its folder", "choose another folder");
}

void check_writable(const std::vector<fs::path>& paths) {
  std::vector<fs::path> places;
  for (const fs::path& path : paths) {
    check_writable(path);
    places.push_back(place_of(path));
    if (std::count(places.begin(), places.end(), places.back()) > 1) refuse_second_output(path);
  }
}

}  // namespace ductile::meshadapt
