// CSV logs: one header line, then one row per sample.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "cablefit/log/line_buffer.hpp"
#include "cablefit/log/log_reader.hpp"

namespace cablefit {

/// Any text that is not JSON.
bool looks_like_csv(std::string_view head);

/// `block_bytes`: how much is read at once.
std::unique_ptr<LogReader> open_csv(std::unique_ptr<ByteSource> source, const std::string& path,
                                    const LogText& text = {},
                                    std::size_t block_bytes = LineBuffer::kBlockBytes);

}  // namespace cablefit
