// A JSON text as a stream of events with their places, in memory that does not grow with the text.
// nlohmann-json does the parsing, inside json_events.cpp only.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace cablefit {

/// Where a value starts; bytes counted from 1.
struct TextPosition {
  std::size_t line = 1;
  std::size_t column = 1;
};

/// What the parser reports. Throwing from here ends the parse.
class JsonEvents {
 public:
  virtual ~JsonEvents() = default;
  virtual void null(TextPosition at) = 0;
  virtual void boolean(bool value, TextPosition at) = 0;
  virtual void number(double value, TextPosition at) = 0;
  virtual void string(std::string& value, TextPosition at) = 0;  ///< may be moved from
  virtual void key(std::string& name, TextPosition at) = 0;      ///< may be moved from
  virtual void start_object(TextPosition at) = 0;
  virtual void end_object(TextPosition at) = 0;
  virtual void start_array(TextPosition at) = 0;
  virtual void end_array(TextPosition at) = 0;
};

/// Delivers the next bytes of the text, nothing at its end. They stay valid until the next call.
using NextBlock = std::function<std::string_view()>;

/// Comments are skipped. Throws Error(input) for a syntax error, for more than 64 levels and for a
/// text, number, comment or run of blanks of more than 1 MiB, all of which the parser keeps; `name`
/// stands for the file in the messages.
void parse_json_events(const NextBlock& next_block, const std::string& name, JsonEvents& events);

/// The same of any number of values one behind the other.
void parse_json_values(const NextBlock& next_block, const std::string& name, JsonEvents& events);

}  // namespace cablefit
