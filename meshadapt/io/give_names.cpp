#include "io/give_names.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

/// A long name is cut, to leave room for the rest.
std::string stem_of(const fs::path& path) {
  return path.filename().string().substr(0, 200) + ".ductile-";
}

/// The folders of files, open: to bring names to disk takes no memory.
class Folders {
 public:
  explicit Folders(const std::vector<CompleteFile>& unit) {
    std::set<fs::path> folders;
    for (const CompleteFile& file : unit) folders.insert(folder_of(file.wanted));
    descriptors_.reserve(folders.size());
    for (const fs::path& folder : folders)
      descriptors_.push_back(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  }
  Folders(const Folders&) = delete;
  Folders& operator=(const Folders&) = delete;
  ~Folders() {
    for (const int descriptor : descriptors_)
      if (descriptor >= 0) ::close(descriptor);
  }

  /// Where the file system can do that.
  void bring_names_to_disk() const {
    for (const int descriptor : descriptors_) ::fsync(descriptor);
  }

 private:
  std::vector<int> descriptors_;
};

/// Old files of which new ones take the place, under other names meanwhile; in their places again
/// unless they are removed.
class SetAside {
 public:
  SetAside() = default;
  SetAside(const SetAside&) = delete;
  SetAside& operator=(const SetAside&) = delete;
  ~SetAside() {
    std::error_code ignored;
    for (const CompleteFile& file : files_)
      if (!fs::exists(file.wanted, ignored)) fs::rename(file.now, file.wanted, ignored);
  }

  bool empty() const { return files_.empty(); }

  void add(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) return;
    CompleteFile file{{}, path};
    files_.reserve(files_.size() + 1);
    file.now = create_beside(path, "old", [&](const fs::path& name) { return move(path, name); });
    files_.push_back(std::move(file));
  }

  void remove() {
    std::error_code ignored;
    for (const CompleteFile& file : files_) fs::remove(file.now, ignored);
    files_.clear();
  }

 private:
  /// Not onto another file. A second link is nobody else's; not every file system has links.
  static bool move(const fs::path& from, const fs::path& to) {
    if (::link(from.c_str(), to.c_str()) == 0) {
      if (::unlink(from.c_str()) == 0) return true;
      const int code = errno;
      ::unlink(to.c_str());
      errno = code;
      return false;
    }
    if (errno != EEXIST && ::access(to.c_str(), F_OK) == 0) errno = EEXIST;
    return errno != EEXIST && ::rename(from.c_str(), to.c_str()) == 0;
  }

  std::vector<CompleteFile> files_;
};

[[noreturn]] void fail_to_move(const std::vector<CompleteFile>& unit, std::size_t failed,
                               const std::error_code& error) {
  std::string text =
      unit[failed].wanted.string() + ": cannot put the finished file in place, " + error.message();
  for (std::size_t i = 0; i < failed; ++i)
    text += (i == 0 ? "; in place already: " : ", ") + unit[i].wanted.string();
  throw Error(text);
}

}  // namespace

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path create_beside(const fs::path& path, const char* kind,
                       const std::function<bool(const fs::path& name)>& create) {
  const std::string stem = stem_of(path) + kind + "-" + std::to_string(::getpid()) + "-";
  for (int number = 0;; ++number) {
    fs::path name = folder_of(path) / (stem + std::to_string(number));
    if (create(name)) return name;
    const int code = errno;
    if (code == ENOMEM) throw std::bad_alloc();
    if (code != EEXIST || number > 10000)
      throw InputError(path.string() + ": cannot create a file in folder " +
                       folder_of(path).string() + ", " + std::generic_category().message(code) +
                       "; choose another folder");
  }
}

bool bring_to_disk(int descriptor) {
  if (::fsync(descriptor) == 0) return true;
  return errno == EINVAL || errno == ENOSYS || errno == ENOTSUP;  // there is no such thing there
}

void give_names(const std::vector<CompleteFile>& unit) {
  const Folders folders(unit);
  SetAside old;
  for (std::size_t i = 1; i < unit.size(); ++i) old.add(unit[i].wanted);
  if (!old.empty()) folders.bring_names_to_disk();
  for (std::size_t i = 0; i < unit.size(); ++i) {
    std::error_code error;
    fs::rename(unit[i].now, unit[i].wanted, error);
    if (error) fail_to_move(unit, i, error);
    if (i == 0 && unit.size() > 1) folders.bring_names_to_disk();
  }
  folders.bring_names_to_disk();
  old.remove();
}

std::vector<fs::path> left_of(const fs::path& path) {
  std::vector<fs::path> left;
  const std::string stem = stem_of(path);
  std::error_code error;
  for (fs::directory_iterator file(folder_of(path), error), end; !error && file != end;
       file.increment(error))
    if (file->path().filename().string().starts_with(stem)) left.push_back(file->path());
  return left;
}

}  // namespace ductile::meshadapt
