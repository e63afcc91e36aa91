// The table of report formats. A new one is one file with a function and one row in writers.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

struct ReportWriter {
  std::string_view name;
  std::string_view extension;  ///< of --report FILE, ".md"
  std::string_view description;
  std::string (*write)(const Document& document);
  bool figures = false;  ///< shows Document::figures, which cost a pass over the logs
};

std::span<const ReportWriter> report_writers();

/// The writer for a file by its extension; throws Error(usage) that lists what there is, and for
/// .html when the library was built without the page.
const ReportWriter& report_writer_for(const std::string& path);

/// The rows of the table.
std::string write_text(const Document& document);
std::string write_csv(const Document& document);
std::string write_markdown(const Document& document);
std::string write_html(const Document& document);

/// Said when the page is asked for and not there.
inline constexpr const char* kNoHtml = "this cablefit was built without the HTML page";
inline constexpr const char* kNoHtmlHint =
    "write .md, .csv or .txt, or build it with npm and -DCABLEFIT_PAGE=ON";

}  // namespace cablefit
