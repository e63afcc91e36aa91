// What the parser of a JSON log leaves behind: columns, and their values in a spill file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/json/json_events.hpp"
#include "cablefit/log/log_reader.hpp"
#include "cablefit/log/spill_file.hpp"
#include "cablefit/log/words.hpp"

namespace cablefit {

struct JsonColumn {
  enum class Kind { unknown, number, text, date };

  ColumnHeader header;
  Kind kind = Kind::unknown;  ///< decided by the first value
  Words words;                ///< of a text column; its values are indices of these
  long date_origin = 0;       ///< of a date column: day of its first value
  std::size_t first = 0;      ///< where its first value stands in the spill file
  std::size_t n_values = 0;
};

struct JsonTable {
  std::string path;
  bool may_miss = false;  ///< null stands for a missing number
  std::optional<double> sample_rate;
  std::vector<JsonColumn> columns;
  std::size_t n_rows = 0;
  std::size_t stride = 1;                 ///< from one row of a column to the next
  std::optional<std::size_t> first_line;  ///< where the line of row 0 stands in the spill file
  SpillFile values;

  Error error(TextPosition at, const std::string& what, const std::string& hint) const;
  /// What is stored for a value of `column`. Throws Error(input) when it is not of its kind.
  double entry(JsonColumn& column, double value, TextPosition at) const;
  double entry(JsonColumn& column, const std::string& text, TextPosition at) const;
  /// NaN, for a null that may stand there.
  double missing_entry(JsonColumn& column, TextPosition at) const;

 private:
  void require(JsonColumn& column, JsonColumn::Kind kind, TextPosition at) const;
};

/// Both layouts of a JSON log are read by one of these.
class JsonLayout : public JsonEvents {
 public:
  /// After the last event: checks what could not be checked before.
  virtual void finish() = 0;

  void null(TextPosition at) override { throw misplaced("null", at); }
  void boolean(bool value, TextPosition at) override {
    throw misplaced(value ? "true" : "false", at);
  }

 protected:
  /// The error for a value that does not belong where it stands.
  virtual Error misplaced(const std::string& value, TextPosition at) const = 0;
};

}  // namespace cablefit
