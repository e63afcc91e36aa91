// The table of log formats. A new format is one file with these two functions and one row here.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "cablefit/log/byte_source.hpp"
#include "cablefit/log/log_reader.hpp"

namespace cablefit {

inline constexpr const char* kMissingHint =
    "fill it, or leave the row out by --missing drop, or hold the value before by --missing hold";

/// First bytes of a log, which show its format.
inline constexpr std::size_t kHeadBytes = 1u << 16;

struct LogFormatRow {
  LogFormat format;
  std::unique_ptr<LogReader> (*open)(std::unique_ptr<ByteSource> source, const std::string& path,
                                     const LogText& text) = nullptr;
};

/// In the order in which they are tried.
std::span<const LogFormatRow> log_format_rows();

}  // namespace cablefit
