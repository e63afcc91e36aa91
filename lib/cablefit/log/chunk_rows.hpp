// Buffers of a LogChunk while it is being filled.
#pragma once

#include <algorithm>
#include <cstddef>

#include "cablefit/log/log_reader.hpp"

namespace cablefit {

inline void resize_rows(LogChunk& chunk, std::size_t n_rows) {
  for (auto& numbers : chunk.numbers) numbers.resize(n_rows);
  for (auto& texts : chunk.texts) texts.resize(n_rows);
  chunk.lines.resize(n_rows);
}

/// Makes room for row `row`. Room doubles, so a caller may allow far more rows than there are.
inline void make_room(LogChunk& chunk, std::size_t row, std::size_t max_rows) {
  constexpr std::size_t kFirstRows = 4096;
  if (row < chunk.lines.size()) return;
  resize_rows(chunk, std::min(max_rows, std::max(kFirstRows, 2 * row)));
}

}  // namespace cablefit
