// Table 1 of Fichera & Grossard 2017.
#include <fmt/format.h>

#include <algorithm>

#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/writers/text_table.hpp"
#include "cablefit/report/writers/wrap.hpp"

namespace cablefit {
namespace {

constexpr int kPrinted = 2;  // coefficients of a cable in the paper's table
constexpr const char* kTitle = "Stiffness (Table 1)";
constexpr const char* kLinear = "Linear";
constexpr const char* kPolynomial = "Polynomial";

/// A coefficient that some preload has; what has another unit is another one.
struct Coefficient {
  std::string group, name, unit;
};

struct Cell {
  std::string value, sd;
};

/// The parameters of the curve come first, then what was estimated along with it.
std::size_t n_coefficients(const ElasticFit& fit) {
  return static_cast<std::size_t>(fit.covariance.rows());
}

std::string group_of(const ElasticFit& fit) { return is_linear(fit) ? kLinear : kPolynomial; }

std::vector<Coefficient> all_coefficients(const ElasticResult& result) {
  std::vector<Coefficient> all;
  for (const char* group : {kLinear, kPolynomial}) {
    for (const ElasticPreload& preload : result.preloads) {
      for (const ElasticFit& fit : preload.fits) {
        if (group_of(fit) != group) continue;
        for (std::size_t k = 0; k < n_coefficients(fit); ++k) {
          const Estimate& e = fit.parameters[k];
          const bool known = std::any_of(all.begin(), all.end(), [&](const Coefficient& c) {
            return c.group == group && c.name == e.name && c.unit == e.unit;
          });
          if (!known) all.push_back({group, e.name, e.unit});
        }
      }
    }
  }
  // Orders differ between preloads: K1_2 of the second belongs beside K1_1 of the first.
  std::stable_sort(all.begin(), all.end(), [](const Coefficient& a, const Coefficient& b) {
    return a.group == kPolynomial && b.group == kPolynomial && a.name < b.name;
  });
  return all;
}

Cell cell_of(const ElasticPreload& preload, const Coefficient& wanted, Footnotes& notes) {
  for (const ElasticFit& fit : preload.fits) {
    if (group_of(fit) != wanted.group) continue;
    const Estimate* e = find_estimate(fit.parameters, wanted.name);
    if (e == nullptr || e->unit != wanted.unit) continue;
    if (!e->not_identifiable.empty()) {
      return {"not identifiable", notes.mark(e->not_identifiable)};
    }
    if (!e->active_bound.empty())
      return {value_text(e->value, e->sd), notes.mark("at its bound: " + e->active_bound)};
    return {value_text(e->value, e->sd), "+- " + sd_text(e->value, e->sd)};
  }
  return {kNoNumber, ""};
}

std::string range_text(const ElasticPreload& preload) {
  return fmt::format("{:.1f} .. {:.1f}", 1e3 * preload.deflection_low,
                     1e3 * preload.deflection_high);
}

std::string range_unit(const ElasticResult& result) {
  const Axes axes = axes_of(result.preloads);
  return unit_for(axes, "mrad");
}

/// j of "K1_j" and "k[name]_j"; 0 of "K".
int index_of(const Coefficient& c) {
  const std::size_t bar = c.name.rfind('_');
  return bar == std::string::npos ? 0 : std::stoi(c.name.substr(bar + 1));
}

/// The linear stiffness depends on the range it was fitted on, so the range stands beside it.
Table preloads_as_rows(const ElasticResult& result, const std::vector<Coefficient>& coefficients) {
  Table table;
  Footnotes notes;
  const auto is_last_linear = [&](std::size_t k) {
    return coefficients[k].group == kLinear &&
           (k + 1 == coefficients.size() || coefficients[k + 1].group != kLinear);
  };
  table.columns = {{"", "preload", "", true}};
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const Coefficient& c = coefficients[k];
    table.columns.push_back({c.group, c.name, c.unit});
    if (is_last_linear(k)) table.columns.push_back({kLinear, "deflection", range_unit(result)});
  }
  for (const ElasticPreload& preload : result.preloads) {
    std::vector<std::string> values = {preload.name}, sds = {""};
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      const Cell cell = cell_of(preload, coefficients[k], notes);
      values.push_back(cell.value);
      sds.push_back(cell.sd);
      if (!is_last_linear(k)) continue;
      values.push_back(range_text(preload));
      sds.emplace_back();
    }
    table.rows.push_back(values);
    table.rows.push_back(sds);
  }
  table.notes = notes.lines();
  return table;
}

Table coefficients_as_rows(const ElasticResult& result,
                           const std::vector<Coefficient>& coefficients) {
  Table table;
  Footnotes notes;
  table.columns = {{"", "coefficient", "", true}, {"", "unit", "", true}};
  std::vector<std::string> ranges = {"deflection", range_unit(result)};
  for (const ElasticPreload& preload : result.preloads) {
    table.columns.push_back({preload.name, "value", ""});
    table.columns.push_back({preload.name, "sd", "", true});
    ranges.insert(ranges.end(), {range_text(preload), ""});
  }
  table.rows.push_back(ranges);
  for (const Coefficient& c : coefficients) {
    std::vector<std::string> row = {c.name, c.unit};
    for (const ElasticPreload& preload : result.preloads) {
      const Cell cell = cell_of(preload, c, notes);
      row.insert(row.end(), {cell.value, cell.sd});
    }
    table.rows.push_back(row);
  }
  table.notes = notes.lines();
  return table;
}

/// What `table_of` makes of all preloads, in as many tables as it takes to stay within a page.
template <typename TableOf>
std::vector<Table> cut(const ElasticResult& result, TableOf table_of) {
  std::vector<Table> tables;
  ElasticResult some;
  for (const ElasticPreload& preload : result.preloads) {
    ElasticResult more = some;
    more.preloads.push_back(preload);
    more.preloads.back().figures.clear();  // they are large
    if (some.preloads.empty() || text_table_width(table_of(more)) > kTextWidth) {
      more.preloads.erase(more.preloads.begin(), more.preloads.end() - 1);
      tables.emplace_back();
    }
    tables.back() = table_of(more);
    some = std::move(more);
  }
  return tables;
}

Table titled(const char* title, Table table) {
  table.title = title;
  return table;
}

/// A row per coefficient.
std::vector<Table> rows_tables(const ElasticResult& result, const char* title,
                               const std::vector<Coefficient>& coefficients) {
  return cut(result, [&](const ElasticResult& some) {
    return titled(title, coefficients_as_rows(some, coefficients));
  });
}

}  // namespace

std::vector<Table> stiffness_tables(const ElasticResult& result) {
  const std::vector<Coefficient> all = all_coefficients(result);
  std::vector<Coefficient> printed, further;
  for (const Coefficient& c : all) (index_of(c) < kPrinted ? printed : further).push_back(c);
  const Table paper = titled(kTitle, preloads_as_rows(result, printed));
  if (text_table_width(paper) > kTextWidth) return rows_tables(result, kTitle, all);
  std::vector<Table> tables = {paper};
  if (further.empty()) return tables;
  for (Table& table : rows_tables(result, "Stiffness: further coefficients", further))
    tables.push_back(std::move(table));
  return tables;
}

}  // namespace cablefit
