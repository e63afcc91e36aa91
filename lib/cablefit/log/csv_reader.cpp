#include "cablefit/log/csv_reader.hpp"

#include <cassert>
#include <utility>

#include "cablefit/log/chunk_rows.hpp"
#include "cablefit/log/csv_complaint.hpp"
#include "cablefit/log/csv_header.hpp"
#include "cablefit/log/csv_row.hpp"
#include "cablefit/log/csv_selection.hpp"
#include "cablefit/log/words.hpp"

namespace cablefit {
namespace {

template <Delimiter kDelimiter>
class CsvReader final : public LogReader {
 public:
  CsvReader(LogHeader header, LineBuffer lines)
      : header_(std::move(header)),
        lines_(std::move(lines)),
        selection_(header_.columns.size(), {}, {}) {}

  const LogHeader& header() const override { return header_; }

  void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) override {
    assert(n_rows_ == 0);
    words_.resize(texts.size());
    selection_ = CsvSelection(header_.columns.size(), std::move(numbers), std::move(texts));
  }

  const std::vector<std::string>& words(std::size_t k) const override {
    return words_[selection_.text_origin(k)].list();
  }

  bool next(LogChunk& chunk, std::size_t max_rows) override {
    assert(max_rows > 0);
    chunk.numbers.resize(selection_.numbers().size());
    chunk.texts.resize(selection_.texts().size());
    chunk.first_row = n_rows_;
    chunk.n_rows = fill(chunk, max_rows);
    n_rows_ += chunk.n_rows;
    if (n_rows_ == 0) {
      throw input_error({header_.path}, "no rows behind the header", "a log needs samples");
    }
    resize_rows(chunk, chunk.n_rows);
    selection_.copy_repeats(chunk);
    return chunk.n_rows > 0;
  }

 private:
  using Syntax = RowSyntax<kDelimiter>;

  std::size_t fill(LogChunk& chunk, std::size_t max_rows) {
    std::size_t row = 0;
    std::string_view line;
    while (row < max_rows && lines_.next(line)) {
      if (is_skipped(line)) continue;
      make_room(chunk, row, max_rows);
      if (!read_row(line, chunk, row)) throw complaint(line);
      chunk.lines[row++] = lines_.line_number();
    }
    return row;
  }

  static bool is_skipped(std::string_view line) {
    // Digits, signs and letters come after '#', blanks before it: most lines need no second look.
    const bool is_suspect = line.empty() || line.front() <= '#';
    return is_suspect && is_skipped_line(line, kDelimiter);
  }

  bool read_row(std::string_view line, LogChunk& chunk, std::size_t row) {
    const char* const end = line.data() + line.size();
    const char* p = Syntax::skip_blanks(line.data(), end);
    bool is_first = true;
    for (const CsvSelection::Target& target : selection_.targets()) {
      if (!is_first) p = Syntax::next_cell(p, end);
      is_first = false;
      if (p != nullptr) p = read_cell(p, end, target, chunk, row);
      if (p == nullptr) return false;
    }
    return Syntax::is_row_end(p, end);
  }

  const char* read_cell(const char* p, const char* end, const CsvSelection::Target& target,
                        LogChunk& chunk, std::size_t row) {
    if (target.text != CsvSelection::kNowhere) {
      const char* text_end = read_text(p, end, target.text, chunk.texts[target.text][row]);
      if (target.number == CsvSelection::kNowhere) return text_end;
    }
    if (target.number == CsvSelection::kNowhere) return Syntax::skip_cell(p, end);
    return Syntax::number_cell(p, end, chunk.numbers[target.number][row]);
  }

  const char* read_text(const char* p, const char* end, std::size_t k, std::uint32_t& index) {
    std::string_view text;
    p = Syntax::text_cell(p, end, text, scratch_);
    if (p == nullptr) return nullptr;
    index = words_[k].index_of(text);
    if (words_[k].is_full()) throw too_many_words(header_.columns[selection_.texts()[k]]);
    return p;
  }

  Error complaint(std::string_view line) const {
    return row_complaint({line, lines_.line_number()}, header_, kDelimiter, selection_.numbers());
  }

  LogHeader header_;
  LineBuffer lines_;
  CsvSelection selection_;
  std::vector<Words> words_;  // per selected text column
  std::string scratch_;
  std::size_t n_rows_ = 0;
};

template <Delimiter kDelimiter>
std::unique_ptr<LogReader> make_reader(LogHeader header, LineBuffer lines) {
  return std::make_unique<CsvReader<kDelimiter>>(std::move(header), std::move(lines));
}

using MakeReader = std::unique_ptr<LogReader> (*)(LogHeader header, LineBuffer lines);

MakeReader maker_for(Delimiter delimiter) {
  switch (delimiter) {
    case Delimiter::comma:
      return make_reader<Delimiter::comma>;
    case Delimiter::semicolon:
      return make_reader<Delimiter::semicolon>;
    case Delimiter::tab:
      return make_reader<Delimiter::tab>;
    case Delimiter::blanks:
      return make_reader<Delimiter::blanks>;
  }
  return nullptr;
}

}  // namespace

bool looks_like_csv(std::string_view head) { return !head.empty(); }

std::unique_ptr<LogReader> open_csv(std::unique_ptr<ByteSource> source, const std::string& path,
                                    std::size_t block_bytes) {
  LineBuffer lines(std::move(source), path, block_bytes);
  CsvHeader header = read_csv_header(lines, path);
  return maker_for(header.delimiter)(std::move(header.log), std::move(lines));
}

}  // namespace cablefit
