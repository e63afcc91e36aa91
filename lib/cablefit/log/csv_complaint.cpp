#include "cablefit/log/csv_complaint.hpp"

#include <fmt/format.h>

#include <string>

#include "cablefit/base/quote.hpp"
#include "cablefit/log/csv_look_ahead.hpp"
#include "cablefit/log/csv_row.hpp"
#include "cablefit/log/iso_time.hpp"
#include "cablefit/log/log_formats.hpp"

namespace cablefit {
namespace {

std::string label(const LogHeader& header, std::size_t column) {
  const std::string& name = header.columns[column].name;
  return name.empty() ? std::to_string(column + 1) : in_quotes(name);
}

bool is_number(std::string_view text, const LogHeader& header) {
  double value = 0;
  const char* end = text.data() + text.size();
  const char point = header.decimal_comma ? ',' : '.';
  return read_number(text.data(), end, value, point) == end;
}

std::string number_hint(const std::string& text, const LogHeader& header) {
  if (header.decimal_comma) return "numbers of this log have a decimal comma, as 1,5 or -3e-4";
  if (is_decimal_comma_number(text)) return "write the decimal comma as a point, as in 1.5";
  return "write numbers as 1.5 or -3e-4";
}

Error number_complaint(const std::string& text, const LogHeader& header, std::size_t k,
                       const Place& place) {
  const std::string column = label(header, k);
  if (text.empty()) return input_error(place, "empty cell in column " + column, kMissingHint);
  const std::string what = in_quotes(text) + " in column " + column;
  if (is_missing_cell(text)) return input_error(place, what + " is not a number", kMissingHint);
  if (header.columns[k].is_date)
    return input_error(place, what + " is not a date", "write dates as 2026-11-09T10:00:00.125Z");
  return input_error(place, what + " is not a number", number_hint(text, header));
}

}  // namespace

Error row_complaint(const CsvLine& line, const LogHeader& header, Delimiter delimiter,
                    const std::vector<std::size_t>& numbers, bool may_miss) {
  const std::vector<Cell> cells = split_row(line.text, delimiter);
  const auto place = [&](const Cell& cell) {
    return Place{header.path, line.number, cell.offset + 1};
  };
  for (const Cell& cell : cells) {
    if (!cell.text.starts_with('"')) continue;
    return input_error(place(cell), "quote is not closed", "write a cell as \"a, b\"");
  }
  if (cells.size() != header.columns.size()) {
    return input_error({header.path, line.number},
                       fmt::format("row has {} cell{}, the header has {}", cells.size(),
                                   cells.size() == 1 ? "" : "s", header.columns.size()),
                       "give every row one cell per column");
  }
  for (const std::size_t column : numbers) {
    const Cell& cell = cells[column];
    const bool is_missing = may_miss && is_missing_cell(cell.text);
    const bool is_date = header.columns[column].is_date && read_iso_time(cell.text);
    if (!is_missing && !is_date && !is_number(cell.text, header))
      return number_complaint(cell.text, header, column, place(cell));
  }
  return input_error({header.path, line.number}, "row cannot be read", "check its quotes");
}

}  // namespace cablefit
