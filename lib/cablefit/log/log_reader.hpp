// A log as it stands on disk: named columns with the units as written, delivered in chunks so that
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

namespace cablefit {

/// A column as its header names it: "theta [deg]" or "theta (deg)" is name "theta", unit "deg".
struct ColumnHeader {
  std::string name;
  std::string unit;  ///< empty: none given
  Place place;       ///< of the header cell
};

struct LogHeader {
  std::string path;
  std::vector<ColumnHeader> columns;
  std::optional<double>
      sample_rate;  ///< Hz, from JSON "sample_rate"; then there may be no column t
};

/// Consecutive rows of the selected columns. Arrays are indexed [selected column][row].
struct LogChunk {
  std::size_t first_row = 0;  ///< index of row 0 within the log
  std::size_t n_rows = 0;
  std::vector<std::vector<double>> numbers;  ///< of the selected numeric columns, all finite
  std::vector<std::vector<std::uint32_t>>
      texts;                         ///< of the selected text columns: index into words()
  std::vector<std::uint64_t> lines;  ///< line of each row in the file (JSON records too; 0 unknown)
};

/// One pass over one log. Open it again for another pass.
class LogReader {
 public:
  virtual ~LogReader() = default;
  virtual const LogHeader& header() const = 0;
  /// Which columns to deliver, as indices into header().columns, before the first next(). Cells of
  /// other columns are not looked at (they may hold text), but each row must have every cell.
  virtual void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) = 0;
  /// Fills `chunk` (buffers are reused) with up to `max_rows` rows; false at the end of the log.
  /// Throws Error(input) at file:line:column for a cell that is no finite number, a ragged row, a
  /// truncated or corrupt compressed stream, a read error.
  virtual bool next(LogChunk& chunk, std::size_t max_rows) = 0;
  /// Distinct texts seen so far in selected text column `k`.
  virtual const std::vector<std::string>& words(std::size_t k) const = 0;
};

/// Opens by content, not by file name: gzip and zstd are unpacked, '{' or '[' is JSON, else CSV.
/// Throws Error(input) for a missing, empty or binary file, a header without columns or with two
/// columns of one name.
std::unique_ptr<LogReader> open_log(const std::string& path);

class ByteSource;
/// The same from bytes that are open already; `path` is for messages.
std::unique_ptr<LogReader> open_log(std::unique_ptr<ByteSource> bytes, const std::string& path);

/// A row of the table of formats, for `cablefit list formats`.
struct LogFormat {
  std::string_view name;
  std::string_view description;
  /// Whether the first bytes of the unpacked file look like this format.
  bool (*recognises)(std::string_view head);
};
std::span<const LogFormat> log_formats();

}  // namespace cablefit
