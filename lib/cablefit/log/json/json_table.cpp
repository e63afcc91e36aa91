#include "cablefit/log/json/json_table.hpp"

#include <limits>

#include "cablefit/base/quote.hpp"
#include "cablefit/log/iso_time.hpp"

namespace cablefit {

Error JsonTable::error(TextPosition at, const std::string& what, const std::string& hint) const {
  return input_error({path, at.line, at.column}, what, hint);
}

double JsonTable::entry(JsonColumn& column, double value, TextPosition at) const {
  require(column, JsonColumn::Kind::number, at);
  return value;
}

double JsonTable::entry(JsonColumn& column, const std::string& text, TextPosition at) const {
  using Kind = JsonColumn::Kind;
  if (column.kind == Kind::unknown || column.kind == Kind::date) {
    if (const auto time = read_iso_time(text)) {
      if (column.kind == Kind::unknown) column.date_origin = time->day;
      column.kind = Kind::date;
      column.header.is_date = true;
      return seconds_from(*time, column.date_origin);
    }
  }
  require(column, JsonColumn::Kind::text, at);
  const std::uint32_t index = column.words.index_of(text);
  if (column.words.is_full()) throw too_many_words(column.header);
  return index;
}

double JsonTable::missing_entry(JsonColumn& column, TextPosition at) const {
  if (column.kind == JsonColumn::Kind::text) require(column, JsonColumn::Kind::number, at);
  return std::numeric_limits<double>::quiet_NaN();
}

void JsonTable::require(JsonColumn& column, JsonColumn::Kind kind, TextPosition at) const {
  if (column.kind == JsonColumn::Kind::unknown) column.kind = kind;
  if (column.kind == kind) return;
  throw error(at, "column " + in_quotes(column.header.name) + " mixes numbers and texts",
              "write numbers without quotes, texts with them");
}

}  // namespace cablefit
