#include "file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <system_error>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Names the copy of a missing file that a process left when it was killed.
std::string where_it_is(const std::string& name, int code) {
  const auto left = code == ENOENT ? left_of(name) : std::vector<fs::path>();
  return left.empty() ? "" : ", and a run that was ended left " + left.front().string();
}

[[noreturn]] void fail_to_read(const std::string& name, int code) {
  if (code == ENOMEM) throw std::bad_alloc();
  throw InputError(name + ": cannot read the file, " + std::generic_category().message(code) +
                   where_it_is(name, code) + "; check its name and permissions");
}

/// Enlarges the memory for what is read; the size of a pipe is not known in advance.
void grow(FileBytes& bytes, std::size_t& capacity) {
  capacity = std::max<std::size_t>(2 * capacity, 1 << 16);
  bytes.data.resize(capacity);
}

}  // namespace

FileBytes read_bytes(const fs::path& path) {
  FileBytes bytes{path.string(), {}, 0};
  std::error_code error;
  if (path.empty()) throw InputError("expected the name of a file to read, found an empty one");
  if (fs::is_directory(path, error))
    throw InputError(bytes.name + ": expected a file, found a folder; name a file in it");
  if (fs::is_character_file(path, error) || fs::is_block_file(path, error))
    throw InputError(bytes.name + ": expected a file or a pipe, found a device; name a file");
  errno = 0;
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) fail_to_read(bytes.name, errno);
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  const auto known_size = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
  std::size_t capacity = error ? 0 : static_cast<std::size_t>(known_size) + 1;
  bytes.data = runtime::make_unset_vector<char>(runtime::Executor({.threads = 1}), capacity);
  while (!std::feof(file.get())) {
    if (bytes.size == capacity) grow(bytes, capacity);
    bytes.size += std::fread(bytes.data.data() + bytes.size, 1, capacity - bytes.size, file.get());
    if (std::ferror(file.get())) fail_to_read(bytes.name, errno);
  }
  if (bytes.size == 0)
    throw InputError(bytes.name +
                     ": expected a mesh or a field, found an empty file; write it again");
  return bytes;
}

}  // namespace ductile::meshadapt
