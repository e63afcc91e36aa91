// The table of report formats. A new one is one file with a function and one row in writers.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cablefit/report/document.hpp"

namespace cablefit {

struct ReportWriter {
  std::string_view name;
  std::string_view extension;  ///< of --report FILE, ".md"
  std::string_view description;
  std::string (*write)(const Document& document);
};

std::span<const ReportWriter> report_writers();

/// The writer for a file by its extension; throws Error(usage) that lists what there is.
const ReportWriter& report_writer_for(const std::string& path);

/// The rows of the table.
std::string write_text(const Document& document);
std::string write_csv(const Document& document);
std::string write_markdown(const Document& document);

}  // namespace cablefit
