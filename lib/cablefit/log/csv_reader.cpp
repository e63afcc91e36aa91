#include "cablefit/log/csv_reader.hpp"

#include <cassert>
#include <limits>
#include <optional>
#include <utility>

#include "cablefit/log/chunk_rows.hpp"
#include "cablefit/log/csv_complaint.hpp"
#include "cablefit/log/csv_header.hpp"
#include "cablefit/log/csv_look_ahead.hpp"
#include "cablefit/log/csv_row.hpp"
#include "cablefit/log/csv_selection.hpp"
#include "cablefit/log/iso_time.hpp"
#include "cablefit/log/words.hpp"

namespace cablefit {
namespace {

/// How the cells of numeric columns are written.
struct NumberCells {
  char point = '.';
  bool may_miss = false;
  long date_origin = 0;
};

/// Rows of a block of whole lines.
template <Delimiter kDelimiter>
class CsvPiece final : public LogPiece {
 public:
  CsvPiece(const CsvSelection& selection, const NumberCells& cells)
      : selection_(selection), cells_(cells), words_(selection.texts().size()) {
    rows_.numbers.resize(selection.numbers().size());
    rows_.texts.resize(selection.texts().size());
  }

  std::string lines;  ///< each with its line feed

  void parse() override {
    const char* p = lines.data();
    const char* const end = p + lines.size();
    std::size_t row = 0;
    for (; p != end; ++n_lines_) {
      make_room(rows_, row, lines.size());
      const char* next = read_plain_row(p, end, row);
      LineKind kind = LineKind::row;
      if (next == nullptr) {
        const char* const line_end = Syntax::find_line_end(p, end);
        kind = read_line(without_return(p, line_end), row);
        next = line_end + 1;
      }
      if (kind == LineKind::bad) break;
      if (kind == LineKind::row) rows_.lines[row++] = n_lines_;
      p = next;
    }
    rows_.n_rows = row;
    resize_rows(rows_, row);
  }

  LogChunk& rows() { return rows_; }
  const std::vector<std::string>& words(std::size_t k) const { return words_[k].list(); }
  std::uint64_t n_lines() const { return n_lines_; }
  /// The line at which parse() had to stop; it is number n_lines() of this piece.
  const std::optional<std::string_view>& bad_line() const { return bad_line_; }

 private:
  using Syntax = RowSyntax<kDelimiter>;

  static std::string_view without_return(const char* begin, const char* end) {
    if (end != begin && end[-1] == '\r') --end;
    return {begin, static_cast<std::size_t>(end - begin)};
  }

  /// The usual row, digits and delimiters without blanks or quotes, read without looking for its
  /// end first. Returns the begin of the next line, null for any other row.
  const char* read_plain_row(const char* p, const char* end, std::size_t row) {
    if constexpr (Syntax::kBlanksDelimit) return nullptr;
    bool is_first = true;
    for (const CsvSelection::Target& target : selection_.targets()) {
      if (!is_first && *p++ != static_cast<char>(kDelimiter)) return nullptr;
      is_first = false;
      if (target.text != CsvSelection::kNowhere || target.number == CsvSelection::kNowhere)
        return nullptr;
      double& value = rows_.numbers[target.number][row];
      const char* next = read_plain_number(p, value, cells_.point);
      p = next != nullptr ? next : read_number(p, end, value, cells_.point);
      if (p == nullptr) return nullptr;
    }
    if (*p == '\r') ++p;
    return *p == '\n' ? p + 1 : nullptr;
  }

  enum class LineKind { row, skipped, bad };

  LineKind read_line(std::string_view line, std::size_t row) {
    if (is_skipped(line)) return LineKind::skipped;
    if (line.size() <= LineBuffer::kMaxLineBytes && read_row(line, row)) return LineKind::row;
    bad_line_ = line;
    return LineKind::bad;
  }

  static bool is_skipped(std::string_view line) {
    // Digits, signs and letters come after '#', blanks before it: most lines need no second look.
    const bool is_suspect = line.empty() || line.front() <= '#';
    return is_suspect && is_skipped_line(line, kDelimiter);
  }

  bool read_row(std::string_view line, std::size_t row) {
    const char* const end = line.data() + line.size();
    const char* p = Syntax::skip_blanks(line.data(), end);
    bool is_first = true;
    for (const CsvSelection::Target& target : selection_.targets()) {
      if (!is_first) p = Syntax::next_cell(p, end);
      is_first = false;
      if (p != nullptr) p = read_cell(p, end, target, row);
      if (p == nullptr) return false;
    }
    return Syntax::is_row_end(p, end);
  }

  const char* read_cell(const char* p, const char* end, const CsvSelection::Target& target,
                        std::size_t row) {
    if (target.text != CsvSelection::kNowhere) {
      const char* text_end = read_text(p, end, target.text, row);
      if (target.number == CsvSelection::kNowhere) return text_end;
    }
    if (target.number == CsvSelection::kNowhere) return Syntax::skip_cell(p, end);
    double& value = rows_.numbers[target.number][row];
    const char* number_end = Syntax::number_cell(p, end, value, cells_.point);
    return number_end != nullptr ? number_end : read_unusual(p, end, target.is_date, value);
  }

  /// A date, or nothing where a number may miss.
  const char* read_unusual(const char* p, const char* end, bool is_date, double& value) {
    if (!is_date && !cells_.may_miss) return nullptr;
    std::string_view text;
    p = Syntax::text_cell(p, end, text, scratch_);
    if (p == nullptr) return nullptr;
    if (const auto time = is_date ? read_iso_time(text) : std::nullopt) {
      value = seconds_from(*time, cells_.date_origin);
      return p;
    }
    if (!cells_.may_miss || !is_missing_cell(text)) return nullptr;
    value = std::numeric_limits<double>::quiet_NaN();
    return p;
  }

  const char* read_text(const char* p, const char* end, std::size_t k, std::size_t row) {
    std::string_view text;
    p = Syntax::text_cell(p, end, text, scratch_);
    if (p != nullptr) rows_.texts[k][row] = words_[k].index_of(text);
    return p;
  }

  const CsvSelection& selection_;
  const NumberCells& cells_;
  LogChunk rows_;             // texts are indices into words_
  std::vector<Words> words_;  // of this piece, per selected text column
  std::string scratch_;
  std::uint64_t n_lines_ = 0;
  std::optional<std::string_view> bad_line_;
};

template <Delimiter kDelimiter>
class CsvReader final : public LogReader {
 public:
  CsvReader(LogHeader header, LineBuffer lines, const NumberCells& cells)
      : header_(std::move(header)),
        lines_(std::move(lines)),
        cells_(cells),
        selection_(header_.columns, {}, {}),
        n_lines_(lines_.line_number()) {}

  const LogHeader& header() const override { return header_; }

  void select(std::vector<std::size_t> numbers, std::vector<std::size_t> texts) override {
    assert(n_rows_ == 0);
    words_.resize(texts.size());
    selection_ = CsvSelection(header_.columns, std::move(numbers), std::move(texts));
  }

  const std::vector<std::string>& words(std::size_t k) const override {
    return words_[selection_.text_origin(k)].list();
  }

  /// An empty piece is the last one: finish() then knows how many rows there were.
  std::unique_ptr<LogPiece> take() override {
    if (is_at_end_) return nullptr;
    auto piece = std::make_unique<Piece>(selection_, cells_);
    lines_.take_lines(piece->lines);
    is_at_end_ = piece->lines.empty();
    return piece;
  }

  void finish(LogPiece& some_piece, LogChunk& chunk) override {
    auto& piece = static_cast<Piece&>(some_piece);
    if (piece.bad_line()) throw complaint(*piece.bad_line(), n_lines_ + piece.n_lines() + 1);
    std::swap(chunk, piece.rows());
    chunk.first_row = n_rows_;
    for (std::uint64_t& line : chunk.lines) line += n_lines_ + 1;
    for (std::size_t k = 0; k < chunk.texts.size(); ++k) share_words(piece, k, chunk.texts[k]);
    selection_.copy_repeats(chunk);
    n_rows_ += chunk.n_rows;
    n_lines_ += piece.n_lines();
    if (piece.lines.empty() && n_rows_ == 0) {
      throw input_error({header_.path}, "no rows after the header", "a log needs samples");
    }
  }

 private:
  using Piece = CsvPiece<kDelimiter>;

  /// From indices into the words of the piece to indices into those of the log.
  void share_words(const Piece& piece, std::size_t k, std::vector<std::uint32_t>& indices) {
    std::vector<std::uint32_t> shared;
    for (const std::string& word : piece.words(k)) shared.push_back(words_[k].index_of(word));
    if (words_[k].is_full()) throw too_many_words(header_.columns[selection_.texts()[k]]);
    for (std::uint32_t& index : indices) index = shared.empty() ? 0 : shared[index];
  }

  Error complaint(std::string_view line, std::uint64_t number) const {
    if (line.size() > LineBuffer::kMaxLineBytes) return too_long_line({header_.path, number});
    return row_complaint({line, number}, header_, kDelimiter, selection_.numbers(),
                         cells_.may_miss);
  }

  LogHeader header_;
  LineBuffer lines_;
  NumberCells cells_;
  CsvSelection selection_;
  std::vector<Words> words_;  // per selected text column
  std::size_t n_rows_ = 0;
  std::uint64_t n_lines_;
  bool is_at_end_ = false;
};

template <Delimiter kDelimiter>
std::unique_ptr<LogReader> make_reader(LogHeader header, LineBuffer lines,
                                       const NumberCells& cells) {
  return std::make_unique<CsvReader<kDelimiter>>(std::move(header), std::move(lines), cells);
}

using MakeReader = std::unique_ptr<LogReader> (*)(LogHeader header, LineBuffer lines,
                                                  const NumberCells& cells);

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
                                    const LogText& text, std::size_t block_bytes) {
  LineBuffer lines(std::move(source), path, block_bytes);
  CsvHeader header = read_csv_header(lines, path, text);
  const NumberCells cells{header.log.decimal_comma ? ',' : '.', text.may_miss, header.date_origin};
  return maker_for(header.delimiter)(std::move(header.log), std::move(lines), cells);
}

}  // namespace cablefit
