#include "cablefit/base/json/json_events.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_cursor.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr int kMaxDepth = 64;

// nlohmann's wording -> ours. An empty `what` stands for "unexpected" and the token it names.
struct Rewording {
  std::string_view theirs;
  std::string_view what;
  std::string_view hint;
};

constexpr std::array kRewordings{
    Rewording{"missing closing quote", "text is not closed", "add a double quote at its end"},
    Rewording{"control character", "line break or control character in a text",
              "write it as \\n, \\t or \\u0001"},
    Rewording{"ill-formed UTF-8", "text is not UTF-8", "save the file as UTF-8"},
    Rewording{"invalid string", "bad escape in a text", "write a backslash as \\\\"},
    Rewording{"invalid comment", "comment is not closed", "write /* .. */ or // .."},
    Rewording{"invalid BOM", "broken byte order mark", "save the file as UTF-8"},
    Rewording{"invalid number", "number is not complete", "write numbers as 1.5 or -3e-4"},
    Rewording{"overflow", "number is too large", "the largest is 1.8e308"},
    Rewording{"invalid literal", "no JSON value starts like this",
              "write texts in double quotes, numbers as 1.5 or -3e-4"},
    Rewording{"unexpected end of input", "text ends too early",
              "close all brackets, or copy the file again"},
    Rewording{"; expected end of input", "", "nothing may follow the closing bracket"},
    Rewording{"; expected string literal", "", "expected a key in double quotes"},
    Rewording{"; expected ':'", "", "put ':' between key and value"},
    Rewording{"; expected '}'", "", "put ',' between members and '}' after the last"},
    Rewording{"; expected ']'", "", "put ',' between values and ']' after the last"},
    Rewording{"", "", "expected a value"},
};

bool mentions(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

// nlohmann: "[..] parse error at ..: syntax error while parsing object - unexpected ','; expected
// '}'". What it quotes of the file comes behind "last read" and is cut off.
std::string_view without_quote(std::string_view theirs) {
  return theirs.substr(0, theirs.find("; last read"));
}

std::string unexpected_token(std::string_view theirs) {
  const std::size_t begin = theirs.rfind("unexpected ");
  if (begin == std::string_view::npos) return "syntax error";
  return std::string(theirs.substr(begin, theirs.find("; expected", begin) - begin));
}

/// `bytes_parsed`: counted from the beginning of the text.
TextPosition error_position(std::string_view theirs, const JsonCursor& cursor,
                            std::size_t bytes_parsed) {
  if (mentions(theirs, "unexpected end of input")) return cursor.end();
  // "1.]" or "tru]": the byte that the parser stumbled over is read, but the word is to blame.
  const bool is_broken_word = mentions(theirs, "invalid") && cursor.word_end() + 1 == bytes_parsed;
  return is_broken_word ? cursor.latest(JsonCursor::word) : cursor.last_before(bytes_parsed);
}

const Rewording& find_rewording(std::string_view theirs) {
  return *std::find_if(kRewordings.begin(), kRewordings.end(),
                       [&](const Rewording& row) { return mentions(theirs, row.theirs); });
}

// Adds places and the depth bound to nlohmann's events.
class Adapter final : public nlohmann::json::json_sax_t {
 public:
  Adapter(const JsonCursor& cursor, const std::string& name, JsonEvents& events)
      : cursor_(cursor), name_(name), events_(events) {}

  bool null() override { return events_.null(word()), true; }
  bool boolean(bool value) override { return events_.boolean(value, word()), true; }
  bool number_integer(std::int64_t value) override {
    return events_.number(static_cast<double>(value), word()), true;
  }
  bool number_unsigned(std::uint64_t value) override {
    return events_.number(static_cast<double>(value), word()), true;
  }
  bool number_float(double value, const std::string&) override {
    return events_.number(value, word()), true;
  }
  bool string(std::string& value) override { return events_.string(value, text()), true; }
  bool key(std::string& name) override { return events_.key(name, text()), true; }
  bool start_object(std::size_t) override {
    enter();
    return events_.start_object(bracket()), true;
  }
  bool start_array(std::size_t) override {
    enter();
    return events_.start_array(bracket()), true;
  }
  bool end_object() override { return --depth_, events_.end_object(bracket()), true; }
  bool end_array() override { return --depth_, events_.end_array(bracket()), true; }
  bool binary(nlohmann::json::binary_t&) override { return false; }  // not in JSON text
  /// Where the value that comes begins.
  void begin_at(std::size_t byte) { first_byte_ = byte; }
  bool parse_error(std::size_t bytes_parsed, const std::string&,
                   const nlohmann::json::exception& error) override {
    const std::string_view theirs = without_quote(error.what());
    const auto& [needle, what, hint] = find_rewording(theirs);
    throw input_error(place(error_position(theirs, cursor_, first_byte_ + bytes_parsed)),
                      what.empty() ? unexpected_token(theirs) : std::string(what),
                      std::string(hint));
  }

 private:
  TextPosition word() const { return cursor_.latest(JsonCursor::word); }
  TextPosition text() const { return cursor_.latest(JsonCursor::text); }
  TextPosition bracket() const { return cursor_.latest(JsonCursor::punctuation); }

  Place place(TextPosition at) const { return {name_, at.line, at.column}; }

  void enter() {
    if (++depth_ <= kMaxDepth) return;
    throw input_error(place(bracket()), "more than 64 levels of brackets",
                      "nest the values less deeply");
  }

  const JsonCursor& cursor_;
  const std::string& name_;
  JsonEvents& events_;
  int depth_ = 0;
  std::size_t first_byte_ = 0;
};

bool skip_blanks(JsonCursor& cursor) {
  while (!cursor.at_end()) {
    const char c = cursor.current();
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') return true;
    cursor.advance();
  }
  return false;
}

}  // namespace

void parse_json_events(const NextBlock& next_block, const std::string& name, JsonEvents& events) {
  constexpr bool kStrict = true;
  constexpr bool kIgnoreComments = true;
  JsonCursor cursor(next_block, name);
  Adapter adapter(cursor, name, events);
  nlohmann::json::sax_parse(JsonIterator(cursor), JsonIterator(), &adapter,
                            nlohmann::json::input_format_t::json, kStrict, kIgnoreComments);
}

void parse_json_values(const NextBlock& next_block, const std::string& name, JsonEvents& events) {
  constexpr bool kStrict = false;
  constexpr bool kIgnoreComments = true;
  JsonCursor cursor(next_block, name);
  Adapter adapter(cursor, name, events);
  while (skip_blanks(cursor)) {
    adapter.begin_at(cursor.offset());
    nlohmann::json::sax_parse(JsonIterator(cursor), JsonIterator(), &adapter,
                              nlohmann::json::input_format_t::json, kStrict, kIgnoreComments);
  }
}

}  // namespace cablefit
