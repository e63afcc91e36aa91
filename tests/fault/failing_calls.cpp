// Preloaded into the program (LD_PRELOAD): lets one system call fail, as the environment says.
// Calls are counted from 1, over the whole run.
//
//   FAULT_WRITE=K:HOW   the K-th call that writes, i.e. open for writing, mkdir, write, pwrite,
//   fsync,
//                       ftruncate, linkat or rename; HOW: an errno, or "short" for half a write
//   FAULT_READ=K:HOW    the K-th read; HOW: an errno
//   FAULT_OPEN=K:HOW    before the K-th opening of log.csv for reading; HOW: "truncate", "append"
//   or
//                       "replace" is done to it
//   FAULT_NO_NAMELESS   open(O_TMPFILE) is not supported
//   FAULT_WRITE_MS, FAULT_READ_MS   each such call first sleeps so long
//   FAULT_COUNT=FILE    at the end "WRITES READS OPENS" is written there
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr int kShort = -1, kNone = 0;

struct Fault {
  long at = 0;
  const char* how = "";
};

Fault fault_of(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return {};
  char* how = nullptr;
  const long at = std::strtol(text, &how, 10);
  return {at, *how == ':' ? how + 1 : ""};
}

int milliseconds_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atoi(text);
}

std::atomic<long> n_writes{0}, n_reads{0}, n_opens{0};

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

int number_of(const char* how) {
  if (std::strcmp(how, "short") == 0) return kShort;
  if (std::strcmp(how, "EINTR") == 0) return EINTR;
  if (std::strcmp(how, "EIO") == 0) return EIO;
  return ENOSPC;
}

int failure(std::atomic<long>& n_calls, const char* variable, const char* pause) {
  if (const int pause_ms = milliseconds_of(pause))
    ::usleep(1000u * static_cast<unsigned>(pause_ms));
  const Fault fault = fault_of(variable);
  return ++n_calls == fault.at ? number_of(fault.how) : kNone;
}

int write_failure() { return failure(n_writes, "FAULT_WRITE", "FAULT_WRITE_MS"); }

/// Whether the call has to fail: errno is set then. Only a write can be short or interrupted.
bool fails(int failure) {
  if (failure == kNone || failure == kShort || failure == EINTR) return false;
  errno = failure;
  return true;
}

bool ends_with(const char* text, const char* ending) {
  const std::size_t n = std::strlen(text), m = std::strlen(ending);
  return n >= m && std::strcmp(text + n - m, ending) == 0;
}

void spoil(const char* path, const char* how) {
  struct stat status {};
  if (::stat(path, &status) != 0) return;
  if (std::strcmp(how, "truncate") == 0 && ::truncate(path, status.st_size / 2) != 0) return;
  if (std::strcmp(how, "append") == 0) {
    if (std::FILE* file = std::fopen(path, "a")) {
      std::fputs("1e6,0,1,1\n", file);
      std::fclose(file);
    }
  }
  if (std::strcmp(how, "replace") == 0) {
    if (std::FILE* file = std::fopen(path, "w")) {
      std::fputs("t,theta,q,tau,run\n", file);
      for (int i = 0; i < 5000; ++i)
        std::fprintf(file, "%d,%d,%d,0,r%d\n", i, i % 7, i % 3, i % 40);
      std::fclose(file);
    }
  }
}

int checked_open(const char* name, const char* path, int flags, mode_t mode) {
  if ((flags & O_TMPFILE) == O_TMPFILE && std::getenv("FAULT_NO_NAMELESS") != nullptr) {
    errno = EOPNOTSUPP;
    return -1;
  }
  const bool is_writing = (flags & (O_WRONLY | O_RDWR)) != 0;
  if (is_writing && fails(write_failure())) return -1;
  if (!is_writing && ends_with(path, "log.csv")) {
    const Fault fault = fault_of("FAULT_OPEN");
    if (++n_opens == fault.at) spoil(path, fault.how);
  }
  return next<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

mode_t mode_of(int flags, va_list arguments) {
  const bool has_mode = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return has_mode ? va_arg(arguments, mode_t) : 0;
}

struct Counter {
  ~Counter() {
    const char* path = std::getenv("FAULT_COUNT");
    if (path == nullptr) return;
    if (std::FILE* file = std::fopen(path, "w")) {
      std::fprintf(file, "%ld %ld %ld\n", n_writes.load(), n_reads.load(), n_opens.load());
      std::fclose(file);
    }
  }
} counter;

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return checked_open("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return checked_open("open64", path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t n_bytes) {
  const int failure = file > STDERR_FILENO ? write_failure() : kNone;
  if (fails(failure)) return -1;
  if (failure == EINTR) return errno = EINTR, -1;
  if (failure == kShort && n_bytes > 1) n_bytes /= 2;
  return next<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, n_bytes);
}

ssize_t pwrite(int file, const void* bytes, size_t n_bytes, off_t offset) {
  if (fails(write_failure())) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite")(file, bytes, n_bytes, offset);
}

int mkdir(const char* path, mode_t mode) {
  if (fails(write_failure())) return -1;
  return next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

int fsync(int file) {
  if (fails(write_failure())) return -1;
  return next<int (*)(int)>("fsync")(file);
}

int ftruncate(int file, off_t length) {
  if (fails(write_failure())) return -1;
  return next<int (*)(int, off_t)>("ftruncate")(file, length);
}

int linkat(int from, const char* old_path, int to, const char* new_path, int flags) {
  if (fails(write_failure())) return -1;
  return next<int (*)(int, const char*, int, const char*, int)>("linkat")(from, old_path, to,
                                                                          new_path, flags);
}

int rename(const char* from, const char* to) {
  if (fails(write_failure())) return -1;
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

ssize_t read(int file, void* bytes, size_t n_bytes) {
  const int failure_now = failure(n_reads, "FAULT_READ", "FAULT_READ_MS");
  if (failure_now != kNone) return errno = failure_now, -1;
  return next<ssize_t (*)(int, void*, size_t)>("read")(file, bytes, n_bytes);
}

}  // extern "C"
