#include "cablefit/base/files/file_descriptor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace cablefit {
namespace {

namespace fs = std::filesystem;

void require(bool success) {
  if (!success) throw std::system_error(errno, std::generic_category());
}

fs::path resolved(const fs::path& path) { return fs::exists(path) ? fs::canonical(path) : path; }

fs::path made_folder_of(const fs::path& target) {
  fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  fs::create_directories(folder);
  remove_leftovers(folder);
  return folder;
}

std::string proc_path(int number) { return fmt::format("/proc/self/fd/{}", number); }

/// A file without a name, which is gone with the process whatever happens; -1 where the file system
/// has none, or where there is no /proc through which to give it a name later.
int open_nameless(const fs::path& folder) {
  const int number = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (number < 0) {
    const bool has_none = errno == EOPNOTSUPP || errno == EISDIR || errno == ENOENT;
    require(has_none);
    return -1;
  }
  if (::access(proc_path(number).c_str(), F_OK) == 0) return number;
  ::close(number);
  return -1;
}

}  // namespace

Descriptor::Descriptor(int number) : number_(number) { require(number_ >= 0); }

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

void Descriptor::write_all(std::string_view content) const {
  while (!content.empty()) {
    const ssize_t n_written = ::write(number_, content.data(), content.size());
    if (n_written < 0 && errno == EINTR) continue;
    require(n_written >= 0);
    content.remove_prefix(static_cast<std::size_t>(n_written));
  }
}

void Descriptor::flush_to_disk() const { require(::fsync(number_) == 0); }

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
    : target_(resolved(target)), file_(create(made_folder_of(target_))) {}

int TemporaryFile::create(const fs::path& folder) {
  const int nameless = open_nameless(folder);
  if (nameless >= 0) return nameless;
  name_.emplace(target_);
  const int number = ::open(name_->c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (number >= 0) ::flock(number, LOCK_EX | LOCK_NB);  // see remove_leftovers()
  return number;
}

void TemporaryFile::rename_to_target() {
  file_.flush_to_disk();
  if (!name_ && give_name(target_.c_str())) return file_.close();
  if (!name_) {
    // A name can be given to a file only when no other file has it.
    ::flock(file_.number(), LOCK_EX | LOCK_NB);
    name_.emplace(target_);
    require(give_name(name_->c_str()));
  }
  file_.close();
  require(::rename(name_->c_str(), target_.c_str()) == 0);
  name_->keep();
}

bool TemporaryFile::give_name(const char* path) const {
  const std::string file = proc_path(file_.number());
  if (::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0) return true;
  require(errno == EEXIST);
  return false;
}

}  // namespace cablefit
