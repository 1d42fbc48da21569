#include "sink.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

/// True if this process may write a file of so many bytes; the system ends one that writes more.
bool may_have(std::size_t bytes) {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
         bytes <= limit.rlim_cur;
}

}  // namespace

Sink::Sink(std::FILE* file, std::filesystem::path path, bool is_limited)
    : file_(file),
      path_(std::move(path)),
      buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)),
      is_limited_(is_limited) {}

void Sink::write(std::string_view bytes) {
  while (!bytes.empty()) {
    if (used_ == buffer_size) flush();
    const std::size_t part = std::min(bytes.size(), buffer_size - used_);
    std::memcpy(buffer_.get() + used_, bytes.data(), part);
    used_ += part;
    bytes.remove_prefix(part);
  }
}

void Sink::flush() {
  if (error_ == 0) {
    const bool may_grow = !is_limited_ || may_have(flushed_ + used_);
    errno = may_grow ? EIO : EFBIG;
    const std::size_t written = may_grow ? std::fwrite(buffer_.get(), 1, used_, file_) : 0;
    if (written != used_) error_ = errno;
    flushed_ += written;
    used_ = 0;
  }
  errno = error_;
  if (error_ != 0) fail("write");
}

void Sink::fail(const char* action) const {
  const int code = errno;
  if (code == ENOMEM) throw std::bad_alloc();
  throw Error(path_.string() + ": cannot " + action + ", " + std::generic_category().message(code) +
              " after " + std::to_string(flushed_) + " bytes; " +
              (code == EFBIG ? "raise the limit of file sizes (ulimit -f)"
                             : "free disk space or choose another folder"));
}

}  // namespace ductile::meshadapt
