// Reads a whole log and checks what log_reader.hpp promises of its chunks.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "cablefit/log/log_reader.hpp"
#include "tests/fuzz/invariant.hpp"

namespace cablefit::fuzz {

inline bool is_label(std::string_view name) {
  return name == "preload" || name == "phase" || name == "run";
}

inline void check_chunk(const LogReader& reader, const LogChunk& chunk) {
  for (const std::vector<double>& column : chunk.numbers) {
    require(column.size() == chunk.n_rows);
    for (const double value : column) require(std::isfinite(value));
  }
  for (std::size_t k = 0; k < chunk.texts.size(); ++k) {
    require(chunk.texts[k].size() == chunk.n_rows);
    for (const std::uint32_t word : chunk.texts[k]) require(word < reader.words(k).size());
  }
}

/// Columns with the name of a label are read as text, the others as numbers.
inline void read_to_the_end(LogReader& reader) {
  const std::vector<ColumnHeader>& columns = reader.header().columns;
  std::vector<std::size_t> numbers, texts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    (is_label(columns[k].name) ? texts : numbers).push_back(k);
  }
  reader.select(numbers, texts);
  std::size_t n_rows = 0;
  for (LogChunk chunk; reader.next(chunk); n_rows += chunk.n_rows) {
    require(chunk.first_row == n_rows);
    check_chunk(reader, chunk);
  }
  require(n_rows > 0);
}

}  // namespace cablefit::fuzz
