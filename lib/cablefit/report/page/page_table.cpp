#include "cablefit/report/page/page_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "cablefit/report/page/html_text.hpp"
#include "cablefit/report/parts/escape.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kLongCell = 60;  // characters, from which on it is broken into lines
constexpr std::size_t kLongKey = 20;   // the same for the first column on a phone

std::string group_row(const std::vector<Column>& columns) {
  std::string row;
  for (std::size_t k = 0; k < columns.size();) {
    const std::string& group = columns[k].group;
    std::size_t end = k + 1;
    while (end < columns.size() && !group.empty() && columns[end].group == group) ++end;
    row += fmt::format("<th colspan=\"{}\"{}>{}</th>", end - k,
                       group.empty() ? "" : " class=\"group\"", html_text(group));
    k = end;
  }
  return "<tr>" + row + "</tr>";
}

std::string html_header_cell(const Column& column) {
  const std::string unit =
      column.unit.empty() ? ""
                          : fmt::format("<small>[{}]</small>", html_text(pretty_unit(column.unit)));
  return fmt::format("<th scope=\"col\"{}>{}{}</th>", column.is_text ? " class=\"text\"" : "",
                     html_text(column.title), unit);
}

bool has_groups(const std::vector<Column>& columns) {
  for (const Column& column : columns)
    if (!column.group.empty()) return true;
  return false;
}

std::string head_html(const std::vector<Column>& columns) {
  std::string head = has_groups(columns) ? group_row(columns) : "";
  head += "<tr>";
  for (const Column& column : columns) head += html_header_cell(column);
  return "<thead>" + head + "</tr></thead>";
}

std::string cell_html(const Column& column, const std::string& cell, bool is_first) {
  const std::size_t n = n_characters(cell);
  std::string kind = column.is_text ? " text" : "";
  if (n > kLongCell) kind += " long";
  if (is_first && n > kLongKey) kind += " key";
  if (!kind.empty()) kind = fmt::format(" class=\"{}\"", kind.substr(1));
  const bool is_badge = column.is_verdict && !cell.empty() && cell != "-";
  return fmt::format("<td{}>{}</td>", kind,
                     is_badge ? badge_html(cell, tone_of(cell)) : html_text(pretty_cell(cell)));
}

}  // namespace

std::string badge_html(const std::string& text, Tone tone) {
  constexpr std::array<const char*, 3> kTones{"neutral", "good", "bad"};  // in the order of Tone
  return fmt::format("<span class=\"badge {}\">{}</span>", kTones[static_cast<std::size_t>(tone)],
                     html_text(pretty_cell(text)));
}

std::string table_html(const Table& table) {
  std::string html =
      table.title.empty() ? "" : fmt::format("<h4>{}</h4>\n", html_text(table.title));
  html += "<div class=\"scroll\" tabindex=\"0\"><table>" + head_html(table.columns) + "<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      html += cell_html(table.columns[k], row[k], k == 0);
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  for (const std::string& note : table.notes)
    html += fmt::format("<p class=\"note\">{}</p>\n", html_text(pretty_cell(note)));
  return html;
}

std::string decisions_html(const std::vector<DecisionLine>& decisions) {
  Table table;
  for (const char* title : {"choice", "value", "preload", "reason"})
    table.columns.push_back({"", title, "", true});
  for (const DecisionLine& line : decisions)
    table.rows.push_back(
        {line.name, line.value,
         line.where.empty() ? std::string("all") : fmt::format("{}", fmt::join(line.where, ", ")),
         line.reason});
  return table_html(table);
}

}  // namespace cablefit
