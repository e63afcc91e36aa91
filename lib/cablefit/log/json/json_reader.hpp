// JSON logs, in all layouts. The text is parsed once when the log is opened; its values wait in a
// temporary file, so memory does not grow with the log.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "cablefit/log/byte_source.hpp"
#include "cablefit/log/log_reader.hpp"

namespace cablefit {

bool looks_like_json(std::string_view head);
/// A record and another one behind it, not in an array.
bool looks_like_json_lines(std::string_view head);

std::unique_ptr<LogReader> open_json(std::unique_ptr<ByteSource> source, const std::string& path,
                                     const LogText& text);
std::unique_ptr<LogReader> open_json_lines(std::unique_ptr<ByteSource> source,
                                           const std::string& path, const LogText& text);

}  // namespace cablefit
