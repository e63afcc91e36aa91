#include "cablefit/base/files/temporary_name.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>
#include <ctime>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "cablefit/base/files/output_file.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".cablefit-", kSuffix = ".tmp";
constexpr std::time_t kLeftoverSeconds = 60;  // between creating a file and locking it

constexpr int kFree = 0, kFilling = 1, kInUse = 2;

// Where a signal handler finds the names: it can take no lock and follow no pointer that may move.
// More files at once than slots are written all the same, they just outlive a signal.
struct Slot {
  std::atomic<int> state{kFree};  // free, being filled, in use
  std::array<char, PATH_MAX> path{};
};
constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);
std::array<Slot, 8> slots;

std::size_t take_slot(const std::string& path) {
  if (path.size() >= PATH_MAX) return kNoSlot;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    int expected = kFree;
    if (!slots[k].state.compare_exchange_strong(expected, kFilling)) continue;
    std::memcpy(slots[k].path.data(), path.c_str(), path.size() + 1);
    slots[k].state = kInUse;
    return k;
  }
  return kNoSlot;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

fs::path unused_path_beside(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  fs::path path;
  do {  // a file of that name can only be left from a killed process with our process id
    path = folder_of(target) / fmt::format("{}{}-{}{}", kPrefix, ::getpid(), counter++, kSuffix);
  } while (fs::exists(fs::symlink_status(path)));
  return path;
}

bool is_old_and_unlocked(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return false;
  struct stat status {};
  const bool is_old = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
                      status.st_mtime + kLeftoverSeconds < std::time(nullptr);
  const bool is_free = is_old && ::flock(file, LOCK_EX | LOCK_NB) == 0;
  ::close(file);
  return is_free;
}

void look_for_leftovers(const fs::path& folder) {
  static std::mutex guard;
  static std::set<fs::path> seen;
  const std::lock_guard lock(guard);
  if (!seen.insert(folder).second) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) continue;
    if (is_old_and_unlocked(entry.path())) ::unlink(entry.path().c_str());
  }
}

}  // namespace

TemporaryName::TemporaryName(const fs::path& target)
    : path_(unused_path_beside(target)), slot_(take_slot(path_.string())) {}

TemporaryName::~TemporaryName() {
  if (!path_.empty()) ::unlink(path_.c_str());
  keep();
}

void TemporaryName::keep() {
  path_.clear();
  if (slot_ != kNoSlot) slots[slot_].state = kFree;
  slot_ = kNoSlot;
}

void remove_temporaries() noexcept {
  for (const Slot& slot : slots) {
    if (slot.state == kInUse) ::unlink(slot.path.data());
  }
}

void remove_leftovers(const fs::path& folder) noexcept {
  try {
    look_for_leftovers(folder);
  } catch (const std::exception&) {  // a folder that cannot be listed may still be written to
  }
}

}  // namespace cablefit
