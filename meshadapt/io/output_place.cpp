#include "output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __linux__
#include <linux/fs.h>
#include <sys/ioctl.h>
#endif

#include <cerrno>
#include <string>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& why, const std::string& advice) {
  throw InputError(path.string() + ": cannot write, " + why + "; " + advice);
}

/// Whether names may be added to a folder but not changed, or a file only be added to.
bool is_append_only([[maybe_unused]] const fs::path& path) {
#ifdef FS_IOC_GETFLAGS
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  int flags = 0;
  const bool known = ::ioctl(descriptor, FS_IOC_GETFLAGS, &flags) == 0;
  ::close(descriptor);
  return known && (flags & FS_APPEND_FL) != 0;
#else
  return false;
#endif
}

bool is_mount_point([[maybe_unused]] const fs::path& path) {
#ifdef STATX_ATTR_MOUNT_ROOT
  struct statx status {};
  return ::statx(AT_FDCWD, path.c_str(), 0, STATX_BASIC_STATS, &status) == 0 &&
         (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
#else
  return false;
#endif
}

/// As in /tmp, where only who owns a file or the folder may take a name away.
bool is_others_in_sticky_folder(const struct stat& file, const fs::path& folder) {
  struct stat of_folder {};
  if (::geteuid() == 0 || ::stat(folder.c_str(), &of_folder) != 0) return false;
  return (of_folder.st_mode & S_ISVTX) != 0 && of_folder.st_uid != ::geteuid() &&
         file.st_uid != ::geteuid();
}

}  // namespace

void expect_name_to_lead_somewhere(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return;
  if (errno == ENAMETOOLONG)
    refuse(path, "the name is longer than the system takes", "choose a shorter one");
  if (errno == ELOOP)
    refuse(path, "the name is a link that leads to itself, or to one that does",
           "remove the link or choose another name");
}

void expect_replaceable(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (is_append_only(folder))
    refuse(path, "nothing may be replaced in folder " + folder.string(), "choose another folder");
  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0 || !S_ISREG(file.st_mode)) return;
  if (is_others_in_sticky_folder(file, folder))
    refuse(path, "only its owner may replace it in folder " + folder.string(),
           "choose another name or folder");
  if (is_append_only(path)) refuse(path, "it may only be added to", "choose another name");
  if (is_mount_point(path))
    refuse(path, "it is mounted there and cannot be replaced", "choose another name or folder");
}

}  // namespace ductile::meshadapt
