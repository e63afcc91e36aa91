#include "cablefit/report/writers/writers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/report/page/page_parts.hpp"

namespace cablefit {
namespace {

constexpr std::array kWriters{
    ReportWriter{"text", ".txt", "tables as in the terminal, with all details", write_text},
    ReportWriter{"csv", ".csv", "one row per preload, model and parameter, at full precision",
                 write_csv},
    ReportWriter{"markdown", ".md", "tables, choices and warnings", write_markdown},
    ReportWriter{"html", ".html", "one page with interactive plots, needs no network", write_html,
                 true},
};

std::string known_extensions() {
  std::string list;
  for (const ReportWriter& writer : kWriters) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", writer.extension, writer.name);
  }
  return list;
}

}  // namespace

std::string where_text(const DecisionLine& line) {
  return line.where.empty() ? "" : fmt::format("{}: ", fmt::join(line.where, ", "));
}

Document without_details(Document document) {
  std::erase_if(document.tables, [](const Table& table) { return table.detail; });
  return document;
}

std::span<const ReportWriter> report_writers() { return kWriters; }

const ReportWriter& report_writer_for(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  for (const ReportWriter& writer : kWriters) {
    if (writer.extension != extension) continue;
    if (writer.write == write_html && !page_parts::built_in())
      throw usage_error(kNoHtml, kNoHtmlHint);
    return writer;
  }
  if (extension == ".svg")
    throw usage_error("plots are not written as single files",
                      "use --report FILE.html: each plot of the page has a button that saves it as "
                      "SVG");
  throw usage_error(
      extension.empty()
          ? fmt::format("--report {} has no extension to tell the format", in_quotes(path))
          : fmt::format("no report format {}", in_quotes(extension)),
      "there are " + known_extensions());
}

}  // namespace cablefit
