#include "cablefit/base/json/json_cursor.hpp"

#include <cctype>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

bool is_beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

bool is_word_byte(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '+' || c == '.' ||
         is_beyond_ascii(c);
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

void JsonCursor::refill() {
  // The parser keeps all it has read since the token began, blanks and comments as well.
  if (here_.offset - token_.offset > kMaxTokenBytes) {
    throw input_error({name_, token_.position.line, token_.position.column},
                      "more than 1 MiB from here to the next value", "is this the right file?");
  }
  block_ = next_block_();
  at_ = 0;
}

TextPosition JsonCursor::last_before(std::size_t n_bytes) const {
  TokenStart last;
  for (const TokenStart& start : latest_) {
    if (start.offset < n_bytes && start.offset >= last.offset) last = start;
  }
  return last.position;
}

JsonCursor::State JsonCursor::begin_token(char c) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const std::size_t offset = here_.offset;
  const bool is_mark = offset < kByteOrderMark.size() && c == kByteOrderMark[offset];
  if (is_blank(c) || is_mark) return State::between;
  const Token token = c == '"' ? text : is_word_byte(c) ? word : punctuation;
  latest_[token] = here_;
  token_ = here_;
  constexpr std::array next{State::in_word, State::in_text, State::between};
  return c == '/' ? State::slash : next[token];
}

JsonCursor::State JsonCursor::state_after(char c) {
  switch (state_) {
    case State::between:
      return begin_token(c);
    case State::in_word:
      return is_word_byte(c) ? State::in_word : begin_token(c);
    case State::in_text:
      return c == '"' ? State::between : c == '\\' ? State::after_backslash : State::in_text;
    case State::after_backslash:
      return State::in_text;
    case State::slash:
      return c == '*' ? State::comment : State::line_comment;
    case State::line_comment:
      return c == '\n' ? State::between : State::line_comment;
    case State::comment:
      return c == '*' ? State::star : State::comment;
    case State::star:
      return c == '/' ? State::between : c == '*' ? State::star : State::comment;
  }
  return State::between;
}

void JsonCursor::track(char c) {
  state_ = state_after(c);
  ++here_.offset;
  if (state_ == State::in_word) word_end_ = here_.offset;
  ++here_.position.column;
  if (c == '\n') here_.position = {here_.position.line + 1, 1};
}

}  // namespace cablefit
