#include "cablefit/base/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;

void require(bool success) {
  if (!success) throw std::system_error(errno, std::generic_category());
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) { require(number_ >= 0); }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(std::string_view content) {
    while (!content.empty()) {
      const ssize_t n_written = ::write(number_, content.data(), content.size());
      if (n_written < 0 && errno == EINTR) continue;
      require(n_written >= 0);
      content.remove_prefix(static_cast<std::size_t>(n_written));
    }
  }
  void flush_to_disk() { require(::fsync(number_) == 0); }
  void close() {
    const int number = number_;
    number_ = -1;
    require(::close(number) == 0);  // some file systems report a full disk only here
  }

 private:
  int number_;
};

// A new file in `folder` that is removed again unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& folder) : path_(unused_path(folder)), file_(create()) {}
  ~TemporaryFile() {
    if (!renamed_) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view content) {
    file_.write_all(content);
    file_.flush_to_disk();
    file_.close();
  }
  void rename_to(const fs::path& target) {
    require(::rename(path_.c_str(), target.c_str()) == 0);
    renamed_ = true;
  }

 private:
  static fs::path unused_path(const fs::path& folder) {
    static std::atomic<unsigned> counter{0};
    fs::path path;
    do {  // a file of that name can only be left from a killed process with our process id
      path = folder / fmt::format(".cablefit-{}-{}.tmp", ::getpid(), counter++);
    } while (fs::exists(fs::symlink_status(path)));
    return path;
  }
  int create() const {
    return ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  }

  fs::path path_;
  Descriptor file_;
  bool renamed_ = false;
};

void write_stdout(std::string_view content) {
  // By stdio, so that the order with what was printed before is kept.
  require(std::fwrite(content.data(), 1, content.size(), stdout) == content.size());
  require(std::fflush(stdout) == 0);
}

void write_in_place(const fs::path& path, std::string_view content) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  file.write_all(content);
  file.close();
}

void write_by_rename(const fs::path& path, std::string_view content) {
  // A symbolic link stays one: what it points to is replaced.
  const fs::path target = fs::exists(path) ? fs::canonical(path) : path;
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  fs::create_directories(folder);
  TemporaryFile temporary(folder);
  temporary.write(content);
  temporary.rename_to(target);
}

void write_to(const std::string& path, std::string_view content) {
  if (path == "-") return write_stdout(content);
  // A device or a pipe (/dev/null, /dev/stdout) must not be replaced by a file.
  const bool is_special = fs::exists(path) && !fs::is_regular_file(path);
  if (is_special) return write_in_place(path, content);
  write_by_rename(path, content);
}

}  // namespace

void write_whole(const std::string& path, std::string_view content) {
  try {
    write_to(path, content);
  } catch (const std::system_error& failure) {  // also fs::filesystem_error
    throw Error(ErrorKind::output,
                fmt::format("cannot write {}: {}", path == "-" ? "standard output" : path,
                            failure.code().message()));
  }
}

}  // namespace cablefit
