#include "cablefit/log/csv_header.hpp"

#include <algorithm>

#include "cablefit/log/column_header.hpp"
#include "cablefit/log/csv_row.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMaxColumns = 10'000;
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

bool is_number(const Cell& cell) {
  double value = 0;
  const char* end = cell.text.data() + cell.text.size();
  return read_number(cell.text.data(), end, value) == end;
}

void check_cells(const std::vector<Cell>& cells, const Place& place) {
  if (cells.size() > kMaxColumns) {
    throw input_error(place, "more than 10000 columns", "is this a log with one row per sample?");
  }
  if (std::all_of(cells.begin(), cells.end(), is_number)) {
    throw input_error(place, "no header line; the first line holds numbers only",
                      "name the columns, as t,q,theta,tau (a line behind # is a comment)");
  }
}

}  // namespace

CsvHeader read_csv_header(LineBuffer& lines, const std::string& path) {
  std::string_view line;
  if (!next_content_line(lines, line)) {
    throw input_error({path}, "no header line", "name the columns, as t,q,theta,tau");
  }
  const Place place{path, lines.line_number()};
  if (line.find('\r') != std::string_view::npos) {
    throw input_error(place, "lines end in CR alone", "save the file with LF or CRLF line ends");
  }
  CsvHeader header{{path, {}, std::nullopt}, find_delimiter(line)};
  const auto cells = split_header(line, header.delimiter, kMaxColumns + 1);
  check_cells(cells, place);
  for (const Cell& cell : cells) {
    header.log.columns.push_back(to_column_header(cell.text, {path, place.line, cell.offset + 1}));
  }
  check_names(header.log.columns, place);
  return header;
}

}  // namespace cablefit
