#include "cablefit/base/files/standard_input.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

[[noreturn]] void throw_cannot_read() {
  throw input_error({}, fmt::format("cannot read standard input: {}", std::strerror(errno)), "");
}

/// All that comes, in a file that is gone when the process ends.
int copy_of_input() {
  std::FILE* file = std::tmpfile();
  if (file == nullptr) throw_cannot_read();
  std::array<char, 1 << 16> buffer;  // NOLINT(*-member-init): filled before it is read
  for (;;) {
    const ssize_t n = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (n == 0) break;
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw_cannot_read();
    const auto size = static_cast<std::size_t>(n);
    if (std::fwrite(buffer.data(), 1, size, file) != size) throw_cannot_read();
  }
  if (std::fflush(file) != 0) throw_cannot_read();
  return ::fileno(file);
}

}  // namespace

int open_standard_input() {
  static const int copy = copy_of_input();
  const int descriptor =
      ::open(fmt::format("/proc/self/fd/{}", copy).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw_cannot_read();
  return descriptor;
}

}  // namespace cablefit
