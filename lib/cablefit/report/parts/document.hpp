// A report as plain data: what is said, not how it looks. Functions make one from a result
// (elastic_document.hpp, ...), writers turn it into text (writers.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Whether a verdict is what one hopes for. Said in a word as well, never by a colour alone.
enum class Tone { neutral, good, bad };

struct Column {
  std::string group;  ///< printed over neighbours of the same group; may be empty
  std::string title;
  std::string unit;         ///< printed in brackets below the title; may be empty
  bool is_text = false;     ///< flush left; numbers stand flush right
  bool is_verdict = false;  ///< its cells begin with a word that tone_of() knows
};

struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  std::vector<std::string> notes;
  bool detail = false;       ///< for files and for --verbose, not for the usual screen
  bool is_optional = false;  ///< left out on the screen where the answer is long
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

/// What a reader sees first.
struct Headline {
  std::string word;  ///< of the badge: "FAILED", "passed"; may be empty
  Tone tone = Tone::neutral;
  std::string verdict;               ///< one sentence
  std::vector<SummaryLine> numbers;  ///< at most three: what, and value with unit
};

/// What a report was made by. Empty where it is not known, as in a library.
struct Origin {
  std::string date;     ///< "2026-03-01"
  std::string command;  ///< as typed, for a shell
};

struct Document {
  std::string title;
  Headline headline;
  Origin origin;
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

/// Of "passed", "FAILED", "different, within the margin": by what it begins with.
Tone tone_of(std::string_view verdict);

/// The document without its tables of details.
Document without_details(Document document);

}  // namespace cablefit
