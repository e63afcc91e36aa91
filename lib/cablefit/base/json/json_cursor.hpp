// An input iterator over blocks of JSON text. It remembers where the latest tokens started, because
// the parser itself does not report that.
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>

#include "cablefit/base/json/json_events.hpp"

namespace cablefit {

/// Start of a token.
struct TokenStart {
  std::size_t offset = 0;  ///< bytes before it
  TextPosition position;
};

class JsonCursor {
 public:
  enum Token { word, text, punctuation };  // a word is a number or a literal

  static constexpr std::size_t kMaxTokenBytes = std::size_t{1} << 20;

  /// `name` stands for the file in messages.
  JsonCursor(const NextBlock& next_block, const std::string& name)
      : next_block_(next_block), name_(name) {}

  bool at_end() {
    if (at_ == block_.size()) refill();
    return block_.empty();
  }
  char current() const { return block_[at_]; }
  /// Bytes before the one that advance() takes next.
  std::size_t offset() const { return here_.offset; }
  void advance() {
    track(current());
    ++at_;
  }

  /// The parser reads one byte beyond a number, so the start of each sort is kept apart.
  TextPosition latest(Token token) const { return latest_[token].position; }
  /// How many bytes there are up to the end of the latest word.
  std::size_t word_end() const { return word_end_; }
  /// Start of the last token among the first `n_bytes` bytes.
  TextPosition last_before(std::size_t n_bytes) const;
  /// Where the text ends, once it has been read to its end.
  TextPosition end() const { return here_.position; }

 private:
  enum class State {
    between,
    in_word,
    in_text,
    after_backslash,
    slash,
    line_comment,
    comment,
    star
  };

  void refill();
  void track(char c);
  State state_after(char c);
  State begin_token(char c);

  const NextBlock& next_block_;
  const std::string& name_;
  std::string_view block_;
  std::size_t at_ = 0;
  TokenStart here_;  // of the byte that advance() takes next
  std::array<TokenStart, 3> latest_{};
  std::size_t word_end_ = 0;
  TokenStart token_;  // the latest one of any sort
  State state_ = State::between;
};

/// What nlohmann::json::sax_parse() takes; a default-constructed one is the end.
class JsonIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  JsonIterator() = default;
  explicit JsonIterator(JsonCursor& cursor) : cursor_(&cursor) {}

  char operator*() const { return cursor_->current(); }
  JsonIterator& operator++() {
    cursor_->advance();
    return *this;
  }
  /// Only meaningful against the end.
  bool operator!=(const JsonIterator&) const { return !cursor_->at_end(); }

 private:
  JsonCursor* cursor_ = nullptr;
};

}  // namespace cablefit
