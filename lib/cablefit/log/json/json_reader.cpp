#include "cablefit/log/json/json_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "cablefit/base/quote.hpp"
#include "cablefit/log/chunk_rows.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/log/json/json_channels.hpp"
#include "cablefit/log/json/json_records.hpp"
#include "cablefit/log/log_formats.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kBlockBytes = 1u << 16;
constexpr std::size_t kPieceRows = 8192;

// The byte that says what a JSON text is, after blanks and a byte order mark.
char first_byte(std::string_view head) {
  const std::size_t first = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first == std::string_view::npos ? '\0' : head[first];
}

class JsonReader final : public LogReader {
 public:
  explicit JsonReader(std::unique_ptr<JsonTable> table) : table_(std::move(table)) {
    header_.path = table_->path;
    header_.sample_rate = table_->sample_rate;
    for (const JsonColumn& column : table_->columns) header_.columns.push_back(column.header);
  }

  const LogHeader& header() const override { return header_; }

  void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) override {
    assert(n_taken_ == 0);
    for (const std::size_t k : numbers) require_numbers(table_->columns.at(k));
    words_.clear();
    for (const std::size_t k : texts) words_.push_back(table_->columns.at(k).words);
    numbers_ = std::move(numbers);
    texts_ = std::move(texts);
  }

  const std::vector<std::string>& words(std::size_t k) const override { return words_[k].list(); }

  std::unique_ptr<LogPiece> take() override {
    if (n_taken_ >= table_->n_rows) return nullptr;
    const std::size_t n_rows = std::min(kPieceRows, table_->n_rows - n_taken_);
    auto piece = std::make_unique<Piece>(n_taken_, n_rows);
    n_taken_ += n_rows;
    return piece;
  }

  /// All numbers were parsed when the log was opened.
  void finish(LogPiece& some_piece, LogChunk& chunk) override {
    const auto& piece = static_cast<const Piece&>(some_piece);
    chunk.first_row = piece.first_row;
    chunk.n_rows = piece.n_rows;
    chunk.numbers.resize(numbers_.size());
    chunk.texts.resize(texts_.size());
    resize_rows(chunk, chunk.n_rows);
    for (std::size_t k = 0; k < numbers_.size(); ++k) {
      read(table_->columns[numbers_[k]].first, chunk, chunk.numbers[k],
           [](double value) { return value; });
    }
    for (std::size_t k = 0; k < texts_.size(); ++k) read_texts(k, chunk);
    read_lines(chunk);
  }

 private:
  struct Piece final : LogPiece {
    Piece(std::size_t first, std::size_t n) : first_row(first), n_rows(n) {}
    void parse() override {}
    std::size_t first_row, n_rows;
  };

  static void require_numbers(const JsonColumn& column) {
    using Kind = JsonColumn::Kind;
    if (column.kind == Kind::number || column.kind == Kind::date) return;
    if (column.kind == Kind::unknown)
      throw input_error(column.header.place,
                        "column " + in_quotes(column.header.name) + " is empty", "leave it out");
    throw input_error(column.header.place,
                      "column " + in_quotes(column.header.name) + " holds texts, not numbers",
                      "write numbers without quotes");
  }

  void read_texts(std::size_t k, LogChunk& chunk) {
    const JsonColumn& column = table_->columns[texts_[k]];
    if (column.kind == JsonColumn::Kind::text) {
      return read(column.first, chunk, chunk.texts[k], [&](double value) {
        return std::isnan(value) ? words_[k].index_of("") : static_cast<std::uint32_t>(value);
      });
    }
    // Numbers are labels too: "run": [1, 1, 2].
    read(column.first, chunk, chunk.texts[k], [&](double value) {
      const std::string label = std::isnan(value) ? "" : fmt::format("{}", value);
      const std::uint32_t index = words_[k].index_of(label);
      if (words_[k].is_full()) throw too_many_words(column.header);
      return index;
    });
  }

  void read_lines(LogChunk& chunk) {
    if (!table_->first_line) return std::fill(chunk.lines.begin(), chunk.lines.end(), 0);
    read(*table_->first_line, chunk, chunk.lines,
         [](double value) { return static_cast<std::uint64_t>(value); });
  }

  /// The chunk's rows of the column that begins at `first` in the spill file.
  template <typename Value, typename Convert>
  void read(std::size_t first, const LogChunk& chunk, std::vector<Value>& to, Convert convert) {
    const std::size_t stride = table_->stride;
    const std::size_t n_rows_at_once = std::max<std::size_t>(1, kBlockBytes / stride);
    for (std::size_t row = 0; row < chunk.n_rows; row += n_rows_at_once) {
      const std::size_t n = std::min(n_rows_at_once, chunk.n_rows - row);
      block_.resize((n - 1) * stride + 1);
      table_->values.read(first + (chunk.first_row + row) * stride, block_);
      for (std::size_t i = 0; i < n; ++i) to[row + i] = convert(block_[i * stride]);
    }
  }

  std::unique_ptr<JsonTable> table_;
  LogHeader header_;
  std::vector<std::size_t> numbers_;
  std::vector<std::size_t> texts_;
  std::vector<Words> words_;  // per selected text column
  std::vector<double> block_;
  std::size_t n_taken_ = 0;
};

using ParseEvents = void (*)(const NextBlock& next_block, const std::string& name,
                             JsonEvents& events);

void parse(ByteSource& source, JsonLayout& layout, const std::string& path,
           ParseEvents parse_events) {
  std::vector<char> block(kBlockBytes);
  const NextBlock next_block = [&]() -> std::string_view {
    return {block.data(), source.read(block.data(), block.size())};
  };
  parse_events(next_block, path, layout);
  layout.finish();
}

void check(const JsonTable& table) {
  std::vector<ColumnHeader> headers;
  for (const JsonColumn& column : table.columns) headers.push_back(column.header);
  check_names(headers, {table.path});
  if (table.n_rows == 0) throw input_error({table.path}, "no values", "a log needs samples");
}

using MakeLayout = std::unique_ptr<JsonLayout> (*)(JsonTable& table);

std::unique_ptr<LogReader> open_table(ByteSource& text, const std::string& path,
                                      const LogText& options, MakeLayout make_layout,
                                      ParseEvents parse_events) {
  auto table = std::make_unique<JsonTable>();
  table->path = path;
  table->may_miss = options.may_miss;
  parse(text, *make_layout(*table), path, parse_events);
  check(*table);
  return std::make_unique<JsonReader>(std::move(table));
}

/// Behind the bracket that closes the first one of `text`; npos when it stays open.
std::size_t end_of_object(std::string_view text) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') ++i;
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '{') ++depth;
    if (c == '}' && --depth == 0) return i + 1;
  }
  return std::string_view::npos;
}

}  // namespace

bool looks_like_json(std::string_view head) {
  return first_byte(head) == '{' || first_byte(head) == '[';
}

bool looks_like_json_lines(std::string_view head) {
  if (first_byte(head) != '{') return false;
  head.remove_prefix(head.find('{'));
  const std::size_t end = end_of_object(head);
  return end != std::string_view::npos && first_byte(head.substr(end)) == '{';
}

std::unique_ptr<LogReader> open_json(std::unique_ptr<ByteSource> source, const std::string& path,
                                     const LogText& text) {
  PeekableSource peekable(std::move(source));
  const bool is_records = first_byte(peekable.peek(kHeadBytes)) == '[';
  return open_table(peekable, path, text, is_records ? make_records_layout : make_channels_layout,
                    parse_json_events);
}

std::unique_ptr<LogReader> open_json_lines(std::unique_ptr<ByteSource> source,
                                           const std::string& path, const LogText& text) {
  return open_table(*source, path, text, make_lines_layout, parse_json_values);
}

}  // namespace cablefit
