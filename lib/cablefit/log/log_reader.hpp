// A log as stored on disk: named columns with their written units, delivered in chunks so that
// memory does not grow with the log. Nothing is converted, dropped or repaired here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"

namespace cablefit {

/// A column as its header names it: "theta [deg]" or "theta (deg)" is name "theta", unit "deg".
struct ColumnHeader {
  std::string name;
  std::string unit;      ///< empty: none given
  Place place;           ///< of the header cell
  bool is_date = false;  ///< ISO 8601 dates, delivered in s since midnight of the first date
};

struct LogHeader {
  std::string path;
  std::vector<ColumnHeader> columns;
  std::optional<double>
      sample_rate;             ///< Hz, from JSON "sample_rate"; then there may be no column t
  bool decimal_comma = false;  ///< of a CSV log with a delimiter other than the comma
};

/// Layout of a log's text, where the log itself does not show it.
struct LogText {
  std::size_t skipped_lines = 0;  ///< of a CSV log, before its header
  bool units_row = false;         ///< of a CSV log: the line after the header holds units
  bool may_miss = false;          ///< an empty cell, "nan" or null is NaN; otherwise an error
};

/// Consecutive rows of the selected columns. Arrays are indexed [selected column][row].
struct LogChunk {
  std::size_t first_row = 0;  ///< index of row 0 within the log
  std::size_t n_rows = 0;
  /// Of the selected numeric columns: finite, or NaN where cells may be missing.
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<std::uint32_t>>
      texts;                         ///< of the selected text columns: index into words()
  std::vector<std::uint64_t> lines;  ///< line of each row in the file (JSON too); 0: unknown
  std::vector<std::size_t> offsets;  ///< of each row, counted from first_row; empty: 0, 1, 2, ...
};

/// A part of a log that is not parsed yet. Each format has its own kind.
class LogPiece {
 public:
  virtual ~LogPiece() = default;
  /// Reads the numbers. Uses nothing outside this piece, so any thread may parse it. Throws nothing
  /// about the log's content: LogReader::finish() does that.
  virtual void parse() = 0;
};

/// One pass over one log. Open it again for another pass.
class LogReader {
 public:
  virtual ~LogReader() = default;
  virtual const LogHeader& header() const = 0;
  /// Selects the columns to deliver, as indices into header().columns; call it before the first
  /// take(). Cells of other columns are not read (they may contain text), but each row must have
  /// every cell.
  virtual void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) = 0;
  /// The next piece, null at the end of the log; valid as long as the reader. Throws Error(input)
  /// for a truncated or corrupt compressed stream and for a read error.
  virtual std::unique_ptr<LogPiece> take() = 0;
  /// The rows of a parsed piece. Finish pieces in the order in which they were taken. `chunk` is
  /// overwritten. Throws Error(input) at file:line:column for a cell that is no finite number and
  /// for a ragged row.
  virtual void finish(LogPiece& piece, LogChunk& chunk) = 0;
  /// Distinct texts seen so far in selected text column `k`.
  virtual const std::vector<std::string>& words(std::size_t k) const = 0;

  /// take(), parse() and finish() in one: the next rows (at least one), or false at the end of the
  /// log. Throws Error(input) at the end of a log without rows.
  bool next(LogChunk& chunk);
};

/// Detects the format by content, not by file name: gzip and zstd are unpacked, '{' or '[' is JSON,
/// else CSV. Throws Error(input) for a missing, empty or binary file, and for a header without
/// columns or with two columns of one name. `digest` must outlive the reader. At the end of the
/// reader it has seen every byte of the file.
std::unique_ptr<LogReader> open_log(const std::string& path, const LogText& text = {},
                                    Sha256* digest = nullptr);

class ByteSource;
/// As above, from bytes that are open already. `path` is for messages.
std::unique_ptr<LogReader> open_log(std::unique_ptr<ByteSource> bytes, const std::string& path,
                                    const LogText& text = {});

/// A row of the table of formats, for `cablefit list formats`.
struct LogFormat {
  std::string_view name;
  std::string_view description;
  /// Whether the first bytes of the unpacked file look like this format.
  bool (*recognises)(std::string_view head);
};
std::span<const LogFormat> log_formats();

}  // namespace cablefit
