#include "cablefit/base/input_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

[[noreturn]] void throw_cannot_read(const std::string& path) {
  throw Error(ErrorKind::input, "cannot read " + path + ": " + std::strerror(errno));
}

ssize_t read_uninterrupted(int descriptor, char* to, std::size_t n_bytes) {
  ssize_t n_read;
  do {
    n_read = ::read(descriptor, to, n_bytes);
  } while (n_read < 0 && errno == EINTR);
  return n_read;
}

}  // namespace

InputFile::InputFile(std::string path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw_cannot_read(path_);
}

InputFile::~InputFile() { ::close(descriptor_); }

std::size_t InputFile::read(char* to, std::size_t n_bytes) {
  std::size_t n_total = 0;
  while (n_total < n_bytes) {
    const ssize_t n_read = read_uninterrupted(descriptor_, to + n_total, n_bytes - n_total);
    if (n_read < 0) throw_cannot_read(path_);
    if (n_read == 0) break;
    n_total += static_cast<std::size_t>(n_read);
  }
  return n_total;
}

}  // namespace cablefit
