#include "cablefit/log/log_formats.hpp"

#include <algorithm>
#include <array>

#include "cablefit/log/csv_reader.hpp"
#include "cablefit/log/json/json_reader.hpp"

namespace cablefit {
namespace {

std::unique_ptr<LogReader> open_csv_log(std::unique_ptr<ByteSource> source, const std::string& path,
                                        const LogText& text) {
  return open_csv(std::move(source), path, text);
}

// CSV takes every text, so it comes last.
constexpr std::array kRows{
    LogFormatRow{{"json-lines", "a record per line", looks_like_json_lines}, open_json_lines},
    LogFormatRow{{"json", "channels of equal length, or an array of records", looks_like_json},
                 open_json},
    LogFormatRow{
        {"csv", "a header line, then rows of cells between commas, semicolons, tabs or blanks",
         looks_like_csv},
        open_csv_log},
};

}  // namespace

std::span<const LogFormatRow> log_format_rows() { return kRows; }

std::span<const LogFormat> log_formats() {
  static const auto formats = [] {
    std::array<LogFormat, kRows.size()> result{};
    std::transform(kRows.begin(), kRows.end(), result.begin(),
                   [](const LogFormatRow& row) { return row.format; });
    return result;
  }();
  return formats;
}

}  // namespace cablefit
