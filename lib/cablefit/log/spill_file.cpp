#include "cablefit/log/spill_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

std::string temporary_folder() {
  const char* folder = std::getenv("TMPDIR");
  return folder == nullptr || *folder == '\0' ? "/tmp" : folder;
}

[[noreturn]] void throw_failure(const char* action) {
  throw Error(ErrorKind::output,
              fmt::format("cannot {} a temporary file in {}: {}; set TMPDIR to a folder with room",
                          action, temporary_folder(), std::strerror(errno)));
}

int open_unlinked_file() {
  // The file never has a name. Where the file system does not support that, its name is removed at
  // once.
  const int nameless = ::open(temporary_folder().c_str(), O_TMPFILE | O_EXCL | O_RDWR | O_CLOEXEC,
                              S_IRUSR | S_IWUSR);
  if (nameless >= 0) return nameless;
  std::string path = temporary_folder() + "/cablefit-XXXXXX";
  const int descriptor = ::mkostemp(path.data(), O_CLOEXEC);
  if (descriptor < 0) throw_failure("create");
  ::unlink(path.c_str());
  return descriptor;
}

void write_all(int descriptor, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n_written = ::write(descriptor, bytes.data(), bytes.size());
    if (n_written < 0 && errno == EINTR) continue;
    if (n_written < 0) throw_failure("write");
    bytes = bytes.subspan(static_cast<std::size_t>(n_written));
  }
}

void read_all(int descriptor, std::size_t offset, std::span<char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n_read =
        ::pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n_read < 0 && errno == EINTR) continue;
    if (n_read <= 0) throw_failure("read");
    bytes = bytes.subspan(static_cast<std::size_t>(n_read));
    offset += static_cast<std::size_t>(n_read);
  }
}

}  // namespace

SpillFile::~SpillFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SpillFile::append(std::span<const double> values) {
  if (tail_.size() >= kTailSize) flush();
  if (descriptor_ >= 0 && values.size() >= kLongRun) {
    flush();
    write(values);
    return;
  }
  tail_.insert(tail_.end(), values.begin(), values.end());
}

void SpillFile::flush() {
  if (descriptor_ < 0) descriptor_ = open_unlinked_file();
  write(tail_);
  tail_.clear();
}

void SpillFile::write(std::span<const double> values) {
  write_all(descriptor_, {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  n_written_ += values.size();
}

void SpillFile::read(std::size_t first, std::span<double> to) const {
  assert(first + to.size() <= size());
  const std::size_t n_in_file = first < n_written_ ? std::min(to.size(), n_written_ - first) : 0;
  const std::span<double> from_file = to.first(n_in_file);
  const std::size_t offset = first * sizeof(double);
  read_all(descriptor_, offset,
           {reinterpret_cast<char*>(from_file.data()), from_file.size_bytes()});
  const std::size_t n_in_tail = to.size() - n_in_file;
  if (n_in_tail == 0) return;
  const double* tail = tail_.data() + (first + n_in_file - n_written_);
  std::copy_n(tail, n_in_tail, to.data() + n_in_file);
}

}  // namespace cablefit
