#include "tests/log/log_support.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <stdexcept>

namespace cablefit::test {
namespace {

std::size_t column_index(const LogHeader& header, const std::string& name) {
  const auto found = std::find_if(header.columns.begin(), header.columns.end(),
                                  [&](const ColumnHeader& column) { return column.name == name; });
  if (found == header.columns.end()) throw std::logic_error("no column " + name);
  return static_cast<std::size_t>(found - header.columns.begin());
}

std::vector<std::size_t> column_indices(const LogHeader& header,
                                        const std::vector<std::string>& names) {
  std::vector<std::size_t> indices;
  for (const std::string& name : names) indices.push_back(column_index(header, name));
  return indices;
}

void append(const LogChunk& chunk, const LogReader& reader, WholeLog& log) {
  for (std::size_t k = 0; k < log.numbers.size(); ++k) {
    log.numbers[k].insert(log.numbers[k].end(), chunk.numbers[k].begin(), chunk.numbers[k].end());
  }
  for (std::size_t k = 0; k < log.texts.size(); ++k) {
    for (const std::uint32_t word : chunk.texts[k]) {
      log.texts[k].push_back(reader.words(k).at(word));
    }
  }
  log.lines.insert(log.lines.end(), chunk.lines.begin(), chunk.lines.end());
}

}  // namespace

std::string gzipped(std::string_view text) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("deflateInit2");
  }
  std::string packed(deflateBound(&stream, text.size()), '\0');
  std::string input(text);
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string zstd_packed(std::string_view text) {
  std::string packed(ZSTD_compressBound(text.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), text.data(), text.size(), 3));
  return packed;
}

WholeLog read_all(LogReader& reader, const std::vector<std::string>& numbers,
                  const std::vector<std::string>& texts) {
  reader.select(column_indices(reader.header(), numbers), column_indices(reader.header(), texts));
  WholeLog log;
  log.numbers.resize(numbers.size());
  log.texts.resize(texts.size());
  LogChunk chunk;
  while (reader.next(chunk)) {
    if (chunk.first_row != log.lines.size()) throw std::logic_error("first_row");
    append(chunk, reader, log);
  }
  return log;
}

}  // namespace cablefit::test
