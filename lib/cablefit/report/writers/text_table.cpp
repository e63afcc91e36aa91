#include "cablefit/report/writers/text_table.hpp"

#include <algorithm>
#include <numeric>

#include "cablefit/report/parts/escape.hpp"
#include "cablefit/report/writers/wrap.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kGap = 2;         // blanks between columns
constexpr std::size_t kLeastText = 12;  // characters of a text column that is wrapped

std::string unit_line(const Column& column) {
  return column.unit.empty() ? "" : "[" + column.unit + "]";
}

/// Neighbouring columns under one group title.
struct Span {
  std::size_t first = 0, count = 1;
};

std::vector<Span> group_spans(const Table& table) {
  std::vector<Span> spans;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const std::string& group = table.columns[k].group;
    if (k > 0 && !group.empty() && group == table.columns[k - 1].group) {
      ++spans.back().count;
    } else {
      spans.push_back({k, 1});
    }
  }
  return spans;
}

std::size_t width_of(const std::vector<std::size_t>& widths, const Span& span) {
  const auto first = widths.begin() + static_cast<std::ptrdiff_t>(span.first);
  const auto last = first + static_cast<std::ptrdiff_t>(span.count);
  return std::accumulate(first, last, kGap * (span.count - 1));
}

std::vector<std::size_t> column_widths(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const Column& column = table.columns[k];
    std::size_t width =
        std::max(n_characters(printable(column.title)), n_characters(printable(unit_line(column))));
    for (const auto& row : table.rows) width = std::max(width, n_characters(printable(row[k])));
    widths.push_back(width);
  }
  for (const Span& span : group_spans(table)) {  // a long group title widens its last column
    const std::size_t wanted = n_characters(printable(table.columns[span.first].group));
    const std::size_t have = width_of(widths, span);
    if (wanted > have) widths[span.first + span.count - 1] += wanted - have;
  }
  return widths;
}

/// The widest text columns give way until all of it fits.
std::vector<std::size_t> fitted_widths(const Table& table) {
  std::vector<std::size_t> widths = column_widths(table);
  const auto least = [&table](std::size_t k) {
    return std::max(kLeastText, n_characters(printable(table.columns[k].title)));
  };
  for (std::size_t all = width_of(widths, {0, widths.size()}); all > kTextWidth; --all) {
    std::size_t widest = widths.size();
    for (std::size_t k = 0; k < widths.size(); ++k)
      if (table.columns[k].is_text && widths[k] > least(k) &&
          (widest == widths.size() || widths[k] > widths[widest]))
        widest = k;
    if (widest == widths.size()) break;
    --widths[widest];
  }
  return widths;
}

enum class Flush { left, right, centre };

std::string padded(const std::string& text, std::size_t width, Flush flush) {
  const std::string shown = printable(text);
  const std::size_t missing = width - std::min(width, n_characters(shown));
  const std::size_t before = flush == Flush::left    ? 0
                             : flush == Flush::right ? missing
                                                     : missing / 2;
  return std::string(before, ' ') + shown + std::string(missing - before, ' ');
}

std::string line_of(const std::vector<std::string>& parts) {
  std::string line;
  for (const std::string& part : parts) {
    if (!line.empty()) line += std::string(kGap, ' ');
    line += part;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string line_of_cells(const Table& table, const std::vector<std::size_t>& widths,
                          const std::vector<std::string>& cells) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Flush flush = table.columns[k].is_text ? Flush::left : Flush::right;
    parts.push_back(padded(cells[k], widths[k], flush));
  }
  return line_of(parts);
}

/// Lines of a row whose texts are wrapped.
std::string lines_of_cells(const Table& table, const std::vector<std::size_t>& widths,
                           const std::vector<std::string>& cells) {
  std::vector<std::vector<std::string>> lines(1, std::vector<std::string>(cells.size()));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const std::string shown = printable(cells[k]);
    const bool fits = !table.columns[k].is_text || n_characters(shown) <= widths[k];
    const std::vector<std::string> pieces =
        fits ? std::vector<std::string>{shown} : wrapped_lines(shown, widths[k]);
    if (pieces.size() > lines.size())
      lines.resize(pieces.size(), std::vector<std::string>(cells.size()));
    for (std::size_t i = 0; i < pieces.size(); ++i) lines[i][k] = pieces[i];
  }
  std::string text;
  for (const std::vector<std::string>& line : lines) text += line_of_cells(table, widths, line);
  return text;
}

std::string header(const Table& table, const std::vector<std::size_t>& widths) {
  std::vector<std::string> groups, titles, units;
  for (const Span& span : group_spans(table)) {
    groups.push_back(
        padded(table.columns[span.first].group, width_of(widths, span), Flush::centre));
  }
  for (const Column& column : table.columns) {
    titles.push_back(column.title);
    units.push_back(unit_line(column));
  }
  std::string text;
  const auto add_unless_blank = [&text](const std::string& line) {
    if (line != "\n") text += line;
  };
  add_unless_blank(line_of(groups));
  add_unless_blank(line_of_cells(table, widths, titles));
  add_unless_blank(line_of_cells(table, widths, units));
  return text;
}

}  // namespace

std::string text_table(const Table& table) {
  const std::vector<std::size_t> widths = fitted_widths(table);
  std::string text = table.title.empty() ? "" : wrapped("", printable(table.title), 0) + "\n";
  text += header(table, widths);
  text += std::string(width_of(widths, {0, widths.size()}), '-') + "\n";
  for (const auto& row : table.rows) text += lines_of_cells(table, widths, row);
  for (const std::string& note : table.notes) text += wrapped("", printable(note), 2);
  return text;
}

std::size_t text_table_width(const Table& table) {
  return width_of(column_widths(table), {0, table.columns.size()});
}

}  // namespace cablefit
