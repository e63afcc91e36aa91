// The tidy table of a document as CSV (RFC 4180, lines end in \n).
#include "cablefit/report/parts/escape.hpp"
#include "cablefit/report/writers/writers.hpp"

namespace cablefit {

std::string write_csv(const Document& document) {
  std::string text;
  const auto add = [&text](const std::string& cell, bool is_first) {
    if (!is_first) text += ',';
    text += csv_cell(cell);
  };
  const Table& table = document.tidy;
  for (std::size_t k = 0; k < table.columns.size(); ++k) add(table.columns[k].title, k == 0);
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) add(row[k], k == 0);
    text += '\n';
  }
  return text;
}

}  // namespace cablefit
