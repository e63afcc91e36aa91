// A report as plain data: what is said, not how it looks. Functions make one from a result
// (elastic_document.hpp, ...), writers turn it into text (writers.hpp).
#pragma once

#include <string>
#include <vector>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

struct Column {
  std::string group;  ///< printed over neighbours of the same group; may be empty
  std::string title;
  std::string unit;      ///< printed in brackets below the title; may be empty
  bool is_text = false;  ///< flush left; numbers stand flush right
};

struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  std::vector<std::string> notes;
  bool detail = false;  ///< for files and for --verbose, not for the usual screen
};

/// "name = value (reason)", for all preloads or for those named.
struct DecisionLine {
  std::vector<std::string> where;  ///< names of preloads; empty: everywhere
  std::string name, value, reason;
};

/// A line of the story in short: "gap", "0.106 -> 0.102 N m".
struct SummaryLine {
  std::string label, text;
};

struct Document {
  std::string title;
  std::vector<SummaryLine> summary;  ///< before the tables
  std::vector<Table> tables;
  std::vector<std::string> paragraphs;  ///< after the tables: reasons, for --verbose and files
  std::vector<DecisionLine> decisions;  ///< likewise
  std::vector<std::string> warnings;
  std::vector<Figure> figures;  ///< in order of sections, then groups
  Table tidy;  ///< one row per preload, model and parameter at full precision, for CSV
};

/// "low, high: " or nothing.
std::string where_text(const DecisionLine& line);

/// The document without its tables of details.
Document without_details(Document document);

}  // namespace cablefit
