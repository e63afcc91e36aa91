#include "cablefit/log/csv_header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/log/column_header.hpp"
#include "cablefit/log/csv_look_ahead.hpp"
#include "cablefit/log/csv_row.hpp"
#include "cablefit/log/iso_time.hpp"

namespace cablefit {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool next_content_line(LineBuffer& lines, std::string_view& line) {
  while (lines.next(line)) {
    if (lines.line_number() == 1 && line.starts_with(kByteOrderMark)) {
      line.remove_prefix(kByteOrderMark.size());
    }
    // Which blanks delimit is not known yet: a header of nothing but tabs names nothing anyway.
    if (!is_skipped_line(line, Delimiter::blanks)) return true;
  }
  return false;
}

bool holds_number(const Cell& cell) {
  double value = 0;
  const char* end = cell.text.data() + cell.text.size();
  return read_number(cell.text.data(), end, value) == end;
}

void check_cells(const std::vector<Cell>& cells, const Place& place) {
  if (cells.size() > kMostColumns) {
    throw input_error(place, "more than 10000 columns", "is this a log with one row per sample?");
  }
  if (std::all_of(cells.begin(), cells.end(), holds_number)) {
    throw input_error(
        place, "no header line; the first line holds numbers only",
        "name the columns, as t,q,theta,tau (a line that starts with # is a comment)");
  }
}

void skip_lines(LineBuffer& lines, std::size_t n_lines) {
  std::string_view line;
  while (n_lines > 0 && lines.next(line)) --n_lines;
}

/// Units of the header's own brackets win.
void take_units_row(LineBuffer& lines, CsvHeader& header) {
  std::string_view line;
  if (!next_content_line(lines, line)) return;
  const std::vector<Cell> units = split_row(line, header.delimiter);
  const Place place{header.log.path, lines.line_number()};
  if (units.size() != header.log.columns.size())
    throw input_error(
        place, fmt::format("{} units of {} columns", units.size(), header.log.columns.size()),
        "give every column a unit, or leave --units-row out");
  for (std::size_t k = 0; k < units.size(); ++k) {
    ColumnHeader& column = header.log.columns[k];
    if (!column.unit.empty() || units[k].text == "-") continue;
    // "[s]" as behind a name.
    const ColumnHeader bracketed = to_column_header("x " + units[k].text, place);
    column.unit = bracketed.unit.empty() ? units[k].text : bracketed.unit;
  }
}

/// What the first rows show about the cells of all.
void look_at_cells(const std::vector<NumberedLine>& lines, CsvHeader& header) {
  header.log.decimal_comma = has_decimal_commas(lines, header.delimiter);
  if (lines.empty()) return;
  const std::vector<Cell> first = split_row(lines.front().text, header.delimiter);
  bool any = false;
  for (std::size_t k = 0; k < std::min(first.size(), header.log.columns.size()); ++k) {
    const auto time = read_iso_time(first[k].text);
    if (!time) continue;
    header.log.columns[k].is_date = true;
    if (!any) header.date_origin = time->day;
    any = true;
  }
}

}  // namespace

CsvHeader read_csv_header(LineBuffer& lines, const std::string& path, const LogText& text) {
  skip_lines(lines, text.skipped_lines);
  std::string_view line;
  if (!next_content_line(lines, line)) {
    throw input_error({path}, "no header line", "name the columns, as t,q,theta,tau");
  }
  const Place place{path, lines.line_number()};
  if (line.find('\r') != std::string_view::npos) {
    throw input_error(place, "lines end in CR alone", "save the file with LF or CRLF line ends");
  }
  CsvHeader header{{path, {}, std::nullopt}, find_delimiter(line)};
  const auto cells = split_header(line, header.delimiter, kMostColumns + 1);
  check_cells(cells, place);
  for (const Cell& cell : cells) {
    header.log.columns.push_back(to_column_header(cell.text, {path, place.line, cell.offset + 1}));
  }
  const std::string header_line(line);  // the buffer moves
  if (text.units_row) take_units_row(lines, header);
  const auto ahead = content_lines(lines.ahead(), lines.line_number() + 1);
  if (const auto complaint = header_complaint({header_line, place.line}, ahead, path))
    throw Error(*complaint);
  check_names(header.log.columns, place);
  look_at_cells(ahead, header);
  return header;
}

}  // namespace cablefit
