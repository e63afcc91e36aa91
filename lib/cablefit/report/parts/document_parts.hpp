// Pieces that the documents of all results share. Internal to report/.
#pragma once

#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// A table whose notes are numbered as they are first mentioned.
class Footnotes {
 public:
  /// "[1]", the same for the same text.
  std::string mark(const std::string& text);
  std::vector<std::string> lines() const;

 private:
  std::vector<std::string> texts_;
};

/// Adds the decisions of one preload; same ones of several preloads share a line.
void add_decisions(Document& document, const std::string& preload,
                   const std::vector<Decision>& decisions);
/// A decision that holds for all of `n_preloads` needs no names.
void finish_decisions(Document& document, std::size_t n_preloads);

/// "low: text", "low, poly: text".
void add_warnings(Document& document, const std::string& where,
                  const std::vector<std::string>& warnings);

/// In the units of the tables.
void add_figures(Document& document, const std::vector<Figure>& figures);

/// Decisions, warnings and figures of the parts of logs; `name`: of a part.
template <typename Part, typename Name>
void add_parts(Document& document, const std::vector<Part>& parts, Name name) {
  for (const Part& part : parts) {
    add_decisions(document, name(part), part.decisions);
    add_warnings(document, name(part), part.warnings);
    add_figures(document, part.figures);
  }
  finish_decisions(document, parts.size());
}

/// A table that has rows; `detail`: see Table::detail.
void add_table(Document& document, Table table);
void add_detail(Document& document, Table table);

/// All of a document behind another, but for its title and summary.
void append(Document& all, const Document& part);

/// Leaves so many main figures, the first; without any the first figures become it.
void lead_with(Document& document, std::size_t n);

/// A number of a headline, and what it is of: a preload or a joint.
struct NamedNumber {
  std::string name, number;
};
/// "1 (low) / 2 (high)", of more the first and the last; one alone needs no name.
std::string joined_numbers(const std::vector<NamedNumber>& numbers);

/// At most four digits of an estimate, fewer where its sd is larger.
std::string headline_value(const Estimate& e);

/// "l_o[1] = 5.110 +- 0.010 mrad, l_o[2] = ...": those that were found; empty without any.
std::string elongations_text(const std::vector<Estimate>& parameters);

/// Columns and one row of the table of rows used.
Table counts_table();
void add_counts(Table& table, const std::string& preload, const std::string& equation,
                const RowCounts& rows, const WindowCounts& windows);

/// Columns and rows of the table of both sd. `where`: titles, then cells, of the properties that
/// distinguish the fits. Parameters that are not identifiable have no row.
Table both_sd_table(const std::vector<std::string>& where);
void add_sd_rows(Table& table, const std::vector<std::string>& where,
                 const std::vector<Estimate>& parameters);

/// Columns and one row of the tidy table.
Table tidy_table();
void add_tidy(Table& table, const std::string& preload, const std::string& model,
              const std::string& method, const Estimate& estimate);
/// A number that is no estimate, e.g. an rms error.
void add_tidy_number(Table& table, const std::string& preload, const std::string& model,
                     const std::string& method, const std::string& name, const std::string& unit,
                     double value);

/// Columns and rows of the table of derived quantities; `where`: preload, or preload and model.
Table derived_table();
void add_derived(Table& table, const std::string& where, const std::vector<Estimate>& derived);

}  // namespace cablefit
