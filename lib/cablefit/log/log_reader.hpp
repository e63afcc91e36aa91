// A log as it is on disk: named columns with the units as written, delivered in chunks so that
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
  bool is_date = false;  ///< ISO 8601 dates, delivered in s from the first one's midnight
};

struct LogHeader {
  std::string path;
  std::vector<ColumnHeader> columns;
  std::optional<double>
      sample_rate;             ///< Hz, from JSON "sample_rate"; then there may be no column t
  bool decimal_comma = false;  ///< of a CSV log whose delimiter leaves it free
};

/// How the text of a log is laid out, where the log itself does not show it.
struct LogText {
  std::size_t skipped_lines = 0;  ///< of a CSV log, before its header
  bool units_row = false;         ///< of a CSV log: the line after the header holds units
  bool may_miss = false;          ///< an empty cell, "nan" or null is NaN; else an error
};

/// Consecutive rows of the selected columns. Arrays are indexed [selected column][row].
struct LogChunk {
  std::size_t first_row = 0;  ///< index of row 0 within the log
  std::size_t n_rows = 0;
  /// Of the selected numeric columns: finite, or NaN where cells may miss.
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<std::uint32_t>>
      texts;                         ///< of the selected text columns: index into words()
  std::vector<std::uint64_t> lines;  ///< line of each row in the file (JSON records too; 0 unknown)
  std::vector<std::size_t> offsets;  ///< of each row from first_row; empty: 0, 1, 2, ...
};

/// What of a log lies between two places, not read yet. Each format has its own kind.
class LogPiece {
 public:
  virtual ~LogPiece() = default;
  /// Reads the numbers. Touches nothing but this piece, so that pieces can be read on any thread.
  /// Throws nothing that concerns the log: that is left to LogReader::finish().
  virtual void parse() = 0;
};

/// One pass over one log. Open it again for another pass.
class LogReader {
 public:
  virtual ~LogReader() = default;
  virtual const LogHeader& header() const = 0;
  /// Which columns to deliver, as indices into header().columns, before the first take(). Cells of
  /// other columns are not looked at (they may hold text), but each row must have every cell.
  virtual void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) = 0;
  /// The next piece, null at the end of the log. Throws Error(input) for a truncated or corrupt
  /// compressed stream and a read error. Valid as long as the reader.
  virtual std::unique_ptr<LogPiece> take() = 0;
  /// The rows of a piece that was parsed, in the order in which the pieces were taken; `chunk` is
  /// overwritten. Throws Error(input) at file:line:column for a cell that is no finite number or a
  /// ragged row.
  virtual void finish(LogPiece& piece, LogChunk& chunk) = 0;
  /// Distinct texts seen so far in selected text column `k`.
  virtual const std::vector<std::string>& words(std::size_t k) const = 0;

  /// take(), parse() and finish() in one: the next rows (at least one); false at the end of the
  /// log, which throws Error(input) when it had no rows.
  bool next(LogChunk& chunk);
};

/// Opens by content, not by file name: gzip and zstd are unpacked, '{' or '[' is JSON, else CSV.
/// Throws Error(input) for a missing, empty or binary file, a header without columns or with two
/// columns of one name. `digest`, which must outlive the reader, has seen every byte of the file
/// when the reader is at its end.
std::unique_ptr<LogReader> open_log(const std::string& path, const LogText& text = {},
                                    Sha256* digest = nullptr);

class ByteSource;
/// The same from bytes that are open already; `path` is for messages.
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
