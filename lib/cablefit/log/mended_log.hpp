// A log with rules for missing cells and repeated times. Every change is counted. Without rules it
// delivers the log unchanged.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/log/log_reader.hpp"

namespace cablefit {

enum class Missing {
  refuse,  ///< an error
  drop,    ///< the row is left out
  hold  ///< the last value is repeated; a row is left out where there is no last value, or no time
};

struct MendingRules {
  Missing missing = Missing::refuse;
  bool first_of_repeated = false;  ///< keeps only the first of rows with the same time
};

struct MendedCounts {
  std::size_t rows_missing = 0;   ///< left out
  std::size_t cells_held = 0;     ///< filled with the last value
  std::size_t rows_repeated = 0;  ///< left out
  std::size_t rows_kept = 0;
  std::vector<std::size_t> cells_missing = {};  ///< per selected number, before filling

  std::size_t n_rows() const { return rows_missing + rows_repeated + rows_kept; }
};

class MendedLog final : public LogReader {
 public:
  /// `time_column`: index into the header's columns, among the numbers that are selected.
  MendedLog(std::unique_ptr<LogReader> log, const MendingRules& rules,
            std::optional<std::size_t> time_column);

  const LogHeader& header() const override { return log_->header(); }
  void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) override;
  std::unique_ptr<LogPiece> take() override { return log_->take(); }
  void finish(LogPiece& piece, LogChunk& chunk) override;
  const std::vector<std::string>& words(std::size_t k) const override { return log_->words(k); }

  /// Counts so far; all 0 where the rules refuse everything.
  const MendedCounts& counts() const { return counts_; }

 private:
  enum class Fate { kept, missing, repeated };

  void mend(LogChunk& chunk);
  bool belongs_to_last(const LogChunk& chunk, std::size_t row) const;
  Fate mend_row(LogChunk& chunk, std::size_t row);
  bool fill(LogChunk& chunk, std::size_t row, bool has_last);
  void remember(const LogChunk& chunk, std::size_t row);

  std::unique_ptr<LogReader> log_;
  MendingRules rules_;
  std::optional<std::size_t> time_column_;
  std::optional<std::size_t> time_;  // among the selected numbers
  MendedCounts counts_;
  std::vector<double> last_;  // numbers of the row kept last
  std::vector<std::uint32_t> last_texts_;
};

}  // namespace cablefit
