// Table 2 of Fichera & Grossard 2017.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/estimate_cells.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/writers/text_table.hpp"
#include "cablefit/report/writers/wrap.hpp"

namespace cablefit {
namespace {

/// A row of the table: a parameter that some fit has.
struct Row {
  std::string name, symbol, unit;
};

std::vector<Row> all_parameters(std::span<const DynamicPreload> preloads) {
  std::vector<Row> rows;
  for (const DynamicPreload& preload : preloads) {
    for (const DynamicFit& fit : preload.fits) {
      for (const Estimate& e : fit.parameters) {
        const bool known = std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
          return row.name == e.name && row.unit == e.unit;
        });
        if (!known) rows.push_back({e.name, e.symbol, e.unit});
      }
    }
  }
  return rows;
}

/// Place of a row in the paper's Table 2; what it does not have comes below.
std::size_t place_of(const Row& row) {
  constexpr std::array kPaper = {"J_link", "J_motor", "f_v", "f_s", "f_vm", "f_sm", "offset"};
  const std::string name = row.name.substr(0, row.name.find('['));
  return static_cast<std::size_t>(std::find(kPaper.begin(), kPaper.end(), name) - kPaper.begin());
}

/// "[1]" of "J_link[1]" and of "stribeck[motor].v_s[1]"; empty: there is one joint, or the
/// parameter is of none.
std::string joint_of(const Row& row) {
  const std::size_t at = row.name.rfind('[');
  return at == std::string::npos || row.name.back() != ']' ? "" : row.name.substr(at);
}

/// In the paper's order, joint by joint. The base parameters of an arm, which stand for J_link,
/// stay before all else.
std::vector<Row> in_order(std::vector<Row> rows) {
  const bool has_link =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return place_of(row) == 0; });
  if (has_link)
    std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
      return std::pair(joint_of(a), place_of(a)) < std::pair(joint_of(b), place_of(b));
    });
  return rows;
}

const Estimate* find_row(const DynamicFit& fit, const Row& row) {
  const Estimate* e = find_estimate(fit.parameters, row.name);
  return e != nullptr && e->unit == row.unit ? e : nullptr;
}

/// CAD values of all preloads; one number when they agree.
std::string cad_text(std::span<const DynamicPreload> preloads, const Row& row) {
  std::vector<double> values;
  for (const DynamicPreload& preload : preloads) {
    for (const DynamicFit& fit : preload.fits) {
      const Estimate* e = find_row(fit, row);
      if (e == nullptr || std::isnan(e->cad)) continue;
      if (std::find(values.begin(), values.end(), e->cad) == values.end()) values.push_back(e->cad);
    }
  }
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : " / ") + fmt::format("{:g}", value);
  return text.empty() ? kNoNumber : text;
}

bool has_load_inertia(std::span<const DynamicPreload> preloads) {
  return std::any_of(preloads.begin(), preloads.end(),
                     [](const DynamicPreload& p) { return p.load_inertia > 0; });
}

std::string label(const Row& row) {
  return row.symbol == row.name ? row.name : row.name + " (" + row.symbol + ")";
}

template <typename CellsOf>
std::vector<std::string> row_of(std::span<const DynamicPreload> preloads,
                                std::vector<std::string> row, CellsOf cells_of_fit) {
  for (const DynamicPreload& preload : preloads) {
    for (const DynamicFit& fit : preload.fits) {
      const EstimateCells cells = cells_of_fit(preload, fit);
      row.insert(row.end(), {cells.value, cells.rsd});
    }
  }
  return row;
}

std::vector<Column> columns_of(std::span<const DynamicPreload> preloads) {
  std::vector<Column> columns = {
      {"", "parameter", "", true}, {"", "unit", "", true}, {"", "CAD", ""}};
  for (const DynamicPreload& preload : preloads) {
    for (const DynamicFit& fit : preload.fits) {
      columns.push_back({preload.name, fit.model, ""});
      columns.push_back({preload.name, "rsd %", ""});
    }
  }
  return columns;
}

/// The paper's sd takes neighbouring rows for independent, which filtered data are not.
std::string sd_note(std::span<const DynamicPreload> preloads) {
  double least = kUnbounded, most = 0;
  for (const DynamicPreload& preload : preloads) {
    for (const DynamicFit& fit : preload.fits) {
      for (const Estimate& e : fit.parameters) {
        if (!e.not_identifiable.empty() || !(e.sd_white > 0) || !(e.sd > e.sd_white)) continue;
        least = std::min(least, e.sd / e.sd_white);
        most = std::max(most, e.sd / e.sd_white);
      }
    }
  }
  if (most == 0) return "";
  return fmt::format(
      "rsd: relative sd that holds for filtered data, {} to {} times that of the paper's (25)",
      significant(least, kRsdDigits), significant(most, kRsdDigits));
}

Table parameter_table(std::span<const DynamicPreload> preloads) {
  Table table;
  Footnotes notes;
  table.title = "Dynamics (Table 2)";
  table.columns = columns_of(preloads);
  for (const Row& row : in_order(all_parameters(preloads))) {
    table.rows.push_back(row_of(preloads, {label(row), row.unit, cad_text(preloads, row)},
                                [&](const DynamicPreload&, const DynamicFit& fit) {
                                  return cells_of(find_row(fit, row), notes);
                                }));
    if (row.name != "J_link" || !has_load_inertia(preloads)) continue;
    table.rows.push_back(row_of(preloads, {"  without the load", row.unit, kNoNumber},
                                [&](const DynamicPreload& preload, const DynamicFit& fit) {
                                  return cells_without_load(find_row(fit, row),
                                                            preload.load_inertia);
                                }));
  }
  table.notes = notes.lines();
  const std::string note = sd_note(preloads);
  if (!note.empty()) table.notes.push_back(note);
  return table;
}

}  // namespace

std::vector<Table> parameter_tables(const DynamicResult& result) {
  std::vector<Table> tables;
  std::span<const DynamicPreload> rest = result.preloads;
  while (!rest.empty()) {
    std::size_t n = 1;
    while (n < rest.size() && text_table_width(parameter_table(rest.first(n + 1))) <= kTextWidth)
      ++n;
    tables.push_back(parameter_table(rest.first(n)));
    rest = rest.subspan(n);
  }
  return tables;
}

}  // namespace cablefit
