#include "cablefit/base/files/read_progress.hpp"

#include <atomic>
#include <chrono>
#include <mutex>

namespace cablefit {
namespace {

// A rig file between two logs would only flicker.
constexpr std::uint64_t kWorthTelling = std::uint64_t{1} << 20;

std::mutex mutex;  // of the pass, which changes once per file
ReadProgress pass;
std::atomic<std::uint64_t> n_bytes_read{0};

}  // namespace

ReadProgress read_progress() {
  const std::lock_guard lock(mutex);
  ReadProgress now = pass;
  now.n_bytes = n_bytes_read.load(std::memory_order_relaxed);
  return now;
}

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void begin_pass(const std::string& path, std::uint64_t n_expected) {
  if (n_expected < kWorthTelling) return;
  const std::lock_guard lock(mutex);
  pass.path = path;
  pass.n_expected = n_expected;
  pass.began = steady_seconds();
  ++pass.n_passes;
  n_bytes_read = 0;
}

void count_read(std::uint64_t n_bytes) {
  n_bytes_read.fetch_add(n_bytes, std::memory_order_relaxed);
}

}  // namespace cablefit
