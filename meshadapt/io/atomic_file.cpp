/// @file
/// AtomicOutputs: each file is written under a temporary name beside its place, brought to disk,
/// and renamed when all are complete. Whenever the process is killed, no reader finds old and new
/// files side by side.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/process.hpp"
#include "output_place.hpp"
#include "sink.hpp"

namespace ductile::meshadapt {

namespace fs = std::filesystem;

// ---- One file ----

class OutputFile {
 public:
  explicit OutputFile(const fs::path& path) : OutputFile(path, is_written_directly(path)) {
    open();  // where this throws, the destructor removes the temporary file
    sink_.emplace(file_, path_, !is_direct_);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    if (file_) std::fclose(file_);
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
  }

  const fs::path& path() const { return path_; }
  /// Empty if the file is written directly, or has its name.
  const fs::path& temporary() const { return temporary_; }
  Sink& sink() { return *sink_; }

  /// Brings all bytes to disk, or to their reader. Throws Error.
  void finish() {
    sink_->flush();
    const bool is_on_disk = is_direct_ || ::fsync(::fileno(file_)) == 0;
    if (!is_on_disk && errno != EINVAL && errno != ENOSYS && errno != ENOTSUP)  // not supported
      sink_->fail("bring to disk");
    errno = 0;
    if (std::fclose(std::exchange(file_, nullptr)) != 0) sink_->fail("close");
  }
  void has_its_name() {
    temporary_.clear();
    vanishing_.reset();
  }

 private:
  OutputFile(fs::path path, bool is_direct) : path_(std::move(path)), is_direct_(is_direct) {}

  void open() {
    if (!is_direct_) {
      const runtime::HeldSignals held;
      temporary_ = create_beside(path_, "tmp");
      vanishing_.emplace(temporary_.c_str());
    }
    file_ = is_direct_ ? open_directly(path_) : std::fopen(temporary_.c_str(), "wb");
    if (!file_ && errno == ENOMEM) throw std::bad_alloc();
    if (!file_)
      throw InputError(path_.string() + ": cannot write, " +
                       std::generic_category().message(errno) + "; choose another folder");
    std::setvbuf(file_, nullptr, _IONBF, 0);
    std::error_code ignored;  // keeping the old file's permissions is a courtesy
    const fs::file_status old = fs::status(path_, ignored);
    if (!is_direct_ && fs::exists(old))
      (void)::fchmod(::fileno(file_), static_cast<mode_t>(old.permissions()));
  }

  fs::path path_, temporary_;
  std::optional<runtime::VanishingFile> vanishing_;
  bool is_direct_;
  std::FILE* file_ = nullptr;
  std::optional<Sink> sink_;
};

namespace {

// ---- Names for several ----

/// The folders of files, open: to bring names to disk takes no memory.
class Folders {
 public:
  explicit Folders(const std::vector<std::unique_ptr<OutputFile>>& files) {
    std::set<fs::path> folders;
    for (const auto& file : files)
      if (!file->temporary().empty()) folders.insert(folder_of(file->path()));
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

  /// Does nothing on file systems that cannot.
  void bring_names_to_disk() const {
    for (const int descriptor : descriptors_) ::fsync(descriptor);
  }

 private:
  std::vector<int> descriptors_;
};

/// Old files under other names, `NAME.ductile-old-PID-N`; they get their names back unless they are
/// removed or their names are taken.
class SetAside {
 public:
  SetAside() = default;
  SetAside(const SetAside&) = delete;
  SetAside& operator=(const SetAside&) = delete;
  ~SetAside() {
    std::error_code ignored;
    for (const auto& [now, before] : files_)
      if (!fs::exists(before, ignored)) fs::rename(now, before, ignored);
  }

  bool empty() const { return files_.empty(); }

  void add(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) return;
    files_.reserve(files_.size() + 1);
    Moved file{create_beside(path, "old"), path};
    fs::rename(path, file.now, error);
    if (error) {
      fs::remove(file.now);
      throw Error(path.string() + ": cannot replace it, " + error.message() +
                  "; change its permissions or choose another name");
    }
    files_.push_back(std::move(file));
  }

  void remove() {
    std::error_code ignored;
    for (const auto& file : files_) fs::remove(file.now, ignored);
    files_.clear();
  }

 private:
  struct Moved {
    fs::path now, before;
  };
  std::vector<Moved> files_;
};

[[noreturn]] void fail_to_move(const std::vector<OutputFile*>& unit, std::size_t failed,
                               const std::error_code& error) {
  std::string text =
      unit[failed]->path().string() + ": cannot put the finished file in place, " + error.message();
  for (std::size_t i = 0; i < failed; ++i)
    text += (i == 0 ? "; in place already: " : ", ") + unit[i]->path().string();
  throw Error(text);
}

/// Moves each file to its place. The files in the places of all but the first are set aside before
/// that: whoever finds the first file finds the others of its unit, or none.
void give_names(const std::vector<std::unique_ptr<OutputFile>>& files) {
  const Folders folders(files);
  std::vector<OutputFile*> unit;
  for (const auto& file : files)
    if (!file->temporary().empty()) unit.push_back(file.get());
  SetAside old;
  for (std::size_t i = 1; i < unit.size(); ++i) old.add(unit[i]->path());
  if (!old.empty()) folders.bring_names_to_disk();
  for (std::size_t i = 0; i < unit.size(); ++i) {
    std::error_code error;
    fs::rename(unit[i]->temporary(), unit[i]->path(), error);
    if (error) fail_to_move(unit, i, error);
    unit[i]->has_its_name();
    if (i == 0 && unit.size() > 1) folders.bring_names_to_disk();
  }
  folders.bring_names_to_disk();
  old.remove();
}

}  // namespace

// ---- Public ----

AtomicOutputs::AtomicOutputs() = default;
AtomicOutputs::~AtomicOutputs() = default;

Sink& AtomicOutputs::stage(const fs::path& path) {
  expect_usable_name(path);
  const fs::path place = place_of(path);
  for (const auto& file : files_)
    if (place_of(file->path()) == place) refuse_second_output(path);
  files_.push_back(std::make_unique<OutputFile>(file_of(path)));
  return files_.back()->sink();
}

void AtomicOutputs::commit() {
  for (const auto& file : files_) file->finish();
  const runtime::HeldSignals held;
  give_names(files_);
  files_.clear();
}

void write_bytes(AtomicOutputs& outputs, const fs::path& path, std::string_view bytes) {
  outputs.stage(path).write(bytes);
}

}  // namespace ductile::meshadapt
