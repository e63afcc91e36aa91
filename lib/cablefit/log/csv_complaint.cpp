#include "cablefit/log/csv_complaint.hpp"

#include <fmt/format.h>

#include <string>

#include "cablefit/base/quote.hpp"
#include "cablefit/log/csv_row.hpp"

namespace cablefit {
namespace {

std::string label(const LogHeader& header, std::size_t column) {
  const std::string& name = header.columns[column].name;
  return name.empty() ? std::to_string(column + 1) : quoted(name);
}

bool is_number(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  return read_number(text.data(), end, value) == end;
}

// "1,5" or "-0,25e3"
bool has_decimal_comma(std::string text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return false;
  text[comma] = '.';
  return is_number(text);
}

std::string number_hint(const std::string& text) {
  if (has_decimal_comma(text)) return "write the decimal comma as a point, as in 1.5";
  return "write numbers as 1.5 or -3e-4";
}

Error number_complaint(const std::string& text, const std::string& column, const Place& place) {
  if (text.empty()) {
    return input_error(place, "empty cell in column " + column, "fill it or take the row out");
  }
  return input_error(place, quoted(text) + " in column " + column + " is not a number",
                     number_hint(text));
}

}  // namespace

Error row_complaint(const CsvLine& line, const LogHeader& header, Delimiter delimiter,
                    const std::vector<std::size_t>& numbers) {
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
    if (!is_number(cell.text)) {
      return number_complaint(cell.text, label(header, column), place(cell));
    }
  }
  return input_error({header.path, line.number}, "row cannot be read", "check its quotes");
}

}  // namespace cablefit
