#include "cablefit/base/file_descriptor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace cablefit {
namespace {

namespace fs = std::filesystem;

void require(bool success) {
  if (!success) throw std::system_error(errno, std::generic_category());
}

fs::path resolved(const fs::path& path) { return fs::exists(path) ? fs::canonical(path) : path; }

fs::path unused_path_beside(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  fs::create_directories(folder);
  fs::path path;
  do {  // a file of that name can only be left from a killed process with our process id
    path = folder / fmt::format(".cablefit-{}-{}.tmp", ::getpid(), counter++);
  } while (fs::exists(fs::symlink_status(path)));
  return path;
}

}  // namespace

Descriptor::Descriptor(int number) : number_(number) { require(number_ >= 0); }

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

void Descriptor::write_all(std::string_view content) {
  while (!content.empty()) {
    const ssize_t n_written = ::write(number_, content.data(), content.size());
    if (n_written < 0 && errno == EINTR) continue;
    require(n_written >= 0);
    content.remove_prefix(static_cast<std::size_t>(n_written));
  }
}

void Descriptor::flush_to_disk() { require(::fsync(number_) == 0); }

void Descriptor::close() {
  const int number = number_;
  number_ = -1;
  require(::close(number) == 0);  // some file systems report a full disk only here
}

bool is_special_file(const fs::path& path) {
  return fs::exists(path) && !fs::is_regular_file(path);
}

int open_in_place(const fs::path& path) { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }

TemporaryFile::TemporaryFile(const fs::path& target)
    : target_(resolved(target)), path_(unused_path_beside(target_)), file_(create()) {}

TemporaryFile::~TemporaryFile() {
  if (!renamed_) ::unlink(path_.c_str());
}

int TemporaryFile::create() const {
  return ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

void TemporaryFile::rename_to_target() {
  file_.flush_to_disk();
  file_.close();
  require(::rename(path_.c_str(), target_.c_str()) == 0);
  renamed_ = true;
}

}  // namespace cablefit
