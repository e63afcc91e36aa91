#include "cablefit/base/files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/read_progress.hpp"
#include "cablefit/base/files/standard_input.hpp"

namespace cablefit {
namespace {

[[noreturn]] void throw_cannot_read(const std::string& path) {
  throw input_error({}, "cannot read " + path + ": " + std::strerror(errno), "");
}

ssize_t read_uninterrupted(int descriptor, char* to, std::size_t n_bytes) {
  ssize_t n_read = 0;
  do {
    n_read = ::read(descriptor, to, n_bytes);
  } while (n_read < 0 && errno == EINTR);
  return n_read;
}

int open_for_reading(const std::string& path) {
  if (path == kStandardInput) return open_standard_input();
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
}

}  // namespace

FileStamp stamp_of(const std::string& path) {
  struct stat status {};
  if (path == kStandardInput) return {};  // nobody writes to its copy
  if (::stat(path.c_str(), &status) != 0) throw_cannot_read(path);
  return {status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
          status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

FileReader::FileReader(std::string path)
    : path_(std::move(path)), descriptor_(open_for_reading(path_)) {
  if (descriptor_ < 0) throw_cannot_read(path_);
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
    begin_pass(path_, static_cast<std::uint64_t>(status.st_size));
    return;
  }
  const bool is_folder = S_ISDIR(status.st_mode);
  ::close(descriptor_);
  if (is_folder) {
    errno = EISDIR;
    throw_cannot_read(path_);
  }
  throw input_error({}, "cannot read " + path_ + ": it is not a regular file",
                    "save the data to a file first: a log is read more than once");
}

FileReader::~FileReader() { ::close(descriptor_); }

std::size_t FileReader::read(char* to, std::size_t n_bytes) {
  std::size_t n_total = 0;
  while (n_total < n_bytes) {
    const ssize_t n_read = read_uninterrupted(descriptor_, to + n_total, n_bytes - n_total);
    if (n_read < 0) throw_cannot_read(path_);
    if (n_read == 0) break;
    n_total += static_cast<std::size_t>(n_read);
  }
  count_read(n_total);
  return n_total;
}

}  // namespace cablefit
