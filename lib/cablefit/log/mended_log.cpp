#include "cablefit/log/mended_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/log/chunk_rows.hpp"

namespace cablefit {
namespace {

void move_row(LogChunk& chunk, std::size_t from, std::size_t to) {
  if (from == to) return;
  for (std::vector<double>& numbers : chunk.numbers) numbers[to] = numbers[from];
  for (std::vector<std::uint32_t>& texts : chunk.texts) texts[to] = texts[from];
  chunk.lines[to] = chunk.lines[from];
}

}  // namespace

MendedLog::MendedLog(std::unique_ptr<LogReader> log, const MendingRules& rules,
                     std::optional<std::size_t> time_column)
    : log_(std::move(log)), rules_(rules), time_column_(time_column) {}

void MendedLog::select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) {
  const auto time =
      time_column_ ? std::find(numbers.begin(), numbers.end(), *time_column_) : numbers.end();
  if (time != numbers.end()) time_ = static_cast<std::size_t>(time - numbers.begin());
  counts_.cells_missing.assign(numbers.size(), 0);
  log_->select(std::move(numbers), std::move(texts));
}

void MendedLog::finish(LogPiece& piece, LogChunk& chunk) {
  chunk.offsets.clear();  // of the chunk before
  log_->finish(piece, chunk);
  if (rules_.missing != Missing::refuse || rules_.first_of_repeated) mend(chunk);
}

void MendedLog::mend(LogChunk& chunk) {
  std::vector<std::size_t> offsets;
  for (std::size_t row = 0; row < chunk.n_rows; ++row) {
    const Fate fate = mend_row(chunk, row);
    counts_.rows_missing += fate == Fate::missing;
    counts_.rows_repeated += fate == Fate::repeated;
    if (fate != Fate::kept) continue;
    ++counts_.rows_kept;
    remember(chunk, row);
    move_row(chunk, row, offsets.size());
    offsets.push_back(row);
  }
  if (offsets.size() < chunk.n_rows) {
    chunk.n_rows = offsets.size();
    resize_rows(chunk, chunk.n_rows);
    chunk.offsets = std::move(offsets);
  }
}

MendedLog::Fate MendedLog::mend_row(LogChunk& chunk, std::size_t row) {
  const bool has_last = belongs_to_last(chunk, row);
  if (!fill(chunk, row, has_last)) return Fate::missing;
  const bool repeated =
      rules_.first_of_repeated && has_last && time_ && chunk.numbers[*time_][row] == last_[*time_];
  return repeated ? Fate::repeated : Fate::kept;
}

bool MendedLog::belongs_to_last(const LogChunk& chunk, std::size_t row) const {
  if (last_.empty()) return false;
  for (std::size_t k = 0; k < chunk.texts.size(); ++k)
    if (chunk.texts[k][row] != last_texts_[k]) return false;
  return true;
}

/// Whether all numbers of the row are there in the end.
bool MendedLog::fill(LogChunk& chunk, std::size_t row, bool has_last) {
  std::size_t n_missing = 0;
  for (std::size_t k = 0; k < chunk.numbers.size(); ++k) {
    const bool is_missing = std::isnan(chunk.numbers[k][row]);
    counts_.cells_missing[k] += is_missing;
    n_missing += is_missing;
  }
  if (n_missing == 0) return true;
  const bool has_time = !time_ || !std::isnan(chunk.numbers[*time_][row]);
  if (rules_.missing != Missing::hold || !has_last || !has_time) return false;
  for (std::size_t k = 0; k < chunk.numbers.size(); ++k)
    if (std::isnan(chunk.numbers[k][row])) chunk.numbers[k][row] = last_[k];
  counts_.cells_held += n_missing;
  return true;
}

void MendedLog::remember(const LogChunk& chunk, std::size_t row) {
  last_.resize(chunk.numbers.size());
  last_texts_.resize(chunk.texts.size());
  for (std::size_t k = 0; k < last_.size(); ++k) last_[k] = chunk.numbers[k][row];
  for (std::size_t k = 0; k < last_texts_.size(); ++k) last_texts_[k] = chunk.texts[k][row];
}

}  // namespace cablefit
