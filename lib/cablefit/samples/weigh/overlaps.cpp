#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr std::size_t kMostRows = 2'000'000;  // of a log; bounds time and memory
constexpr std::size_t kWindow = 64;           // consecutive rows; no motion repeats as many
constexpr std::size_t kFewChanges = 8;        // rows at rest repeat by themselves
constexpr std::uint64_t kEvery = 64;          // about one window of as many is kept
constexpr std::size_t kFewest = 10;           // windows that two logs share
constexpr double kCopy = 0.95;                // duplicates() reports whole logs
constexpr double kLeastShare = 0.05;          // of the shorter log's
constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;  // odd, its bits without a pattern

std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 32;
  x *= kFactor;
  return x ^ (x >> 29);
}

/// Hashes of windows of consecutive rows, chosen by what stands in them: two logs with a stretch in
/// common choose the same ones, wherever it stands.
class WindowHashes {
 public:
  explicit WindowHashes(const LogPlan& plan) {
    for (std::size_t k = 0; k < plan.slots.size(); ++k) {
      const Slot& slot = plan.slots[k];
      const bool measured = slot.channel == Channel::q || slot.channel == Channel::theta ||
                            slot.channel == Channel::w || slot.channel == Channel::tau;
      if (measured && !slot.integrated) columns_.push_back(static_cast<Eigen::Index>(k) + 1);
    }
  }

  void begin() {
    n_ = 0, sum_ = 0, n_changes_ = 0;
    changed_.fill(false);
    recent_.fill(0);
  }
  void add(const Eigen::MatrixXd& rows, Eigen::Index i) {
    std::uint64_t row = 0;
    for (const Eigen::Index k : columns_)
      row = mixed(row * kFactor + std::bit_cast<std::uint64_t>(rows(i, k)));
    const std::size_t at = n_++ % kWindow;
    const bool changes = row != last_;
    n_changes_ += changes;
    n_changes_ -= changed_[at];
    changed_[at] = changes;
    last_ = row;
    sum_ = sum_ * kFactor + row - recent_[at] * oldest_weight();
    recent_[at] = row;
    if (n_ < kWindow || n_changes_ < kFewChanges) return;
    const std::uint64_t hash = mixed(sum_);
    if (hash % kEvery == 0) hashes_.push_back(hash);
  }
  std::vector<std::uint64_t> take() {
    std::sort(hashes_.begin(), hashes_.end());
    hashes_.erase(std::unique(hashes_.begin(), hashes_.end()), hashes_.end());
    return std::move(hashes_);
  }

 private:
  static constexpr std::uint64_t oldest_weight() {
    std::uint64_t weight = 1;
    for (std::size_t k = 0; k < kWindow; ++k) weight *= kFactor;
    return weight;
  }

  std::vector<Eigen::Index> columns_;
  std::array<std::uint64_t, kWindow> recent_{};
  std::array<bool, kWindow> changed_{};
  std::uint64_t sum_ = 0, last_ = 0;
  std::size_t n_ = 0, n_changes_ = 0;
  std::vector<std::uint64_t> hashes_;
};

std::vector<std::uint64_t> hashes_of(const LogSurvey& log) {
  WindowHashes hashes(log.plan);
  std::size_t n = 0;
  Eigen::MatrixXd rows;
  for (const SamplePiece& piece : log.samples->pieces()) {
    if (n > kMostRows) break;
    if (!piece.follows) hashes.begin();
    log.samples->read(piece, rows);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) hashes.add(rows, i);
    n += static_cast<std::size_t>(piece.n_rows);
  }
  return hashes.take();
}

/// Share of the smaller set that both have.
double shared(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  std::vector<std::uint64_t> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  if (both.size() < kFewest) return 0;
  return static_cast<double>(both.size()) / static_cast<double>(std::min(a.size(), b.size()));
}

}  // namespace

/// Logs that were cut from one recording and have a part of it in common.
Findings overlaps(const Logs& logs) {
  Findings findings;
  if (logs.logs.size() < 2) return findings;
  std::vector<std::vector<std::uint64_t>> hashes;
  for (const LogSurvey& log : logs.logs) hashes.push_back(hashes_of(log));
  for (std::size_t b = 1; b < hashes.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const double share = shared(hashes[a], hashes[b]);
      const bool is_copy = logs.logs[a].n_rows == logs.logs[b].n_rows && share > kCopy;
      if (share < kLeastShare || is_copy) continue;
      findings.push_back({b,
                          {},
                          false,
                          fmt::format("shares {:.0f} % of the samples of the shorter log with {}",
                                      100 * share, logs.logs[a].plan.path),
                          "duplicate data make every sd too small; cut the logs apart"});
      break;
    }
  return findings;
}

}  // namespace cablefit::weighing
