#include "cablefit/base/error.hpp"

#include <string_view>

#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

std::string with_hint(const std::string& what, const std::string& hint) {
  if (hint.empty()) return what;
  return what + (what.ends_with('?') ? " " : "; ") + hint;
}

std::string printable_lines(std::string_view message) {
  std::string text;
  for (std::size_t end = 0; (end = message.find('\n')) != std::string_view::npos;) {
    text += printable(message.substr(0, end)) + '\n';
    message.remove_prefix(end + 1);
  }
  return text + printable(message);
}

}  // namespace

Error::Error(ErrorKind kind, const std::string& message)
    : std::runtime_error(printable_lines(message)), kind_(kind) {}

std::string to_string(const Place& place) {
  std::string text = place.file;
  if (place.line == 0) return text;
  text += ':' + std::to_string(place.line);
  if (place.column == 0) return text;
  return text + ':' + std::to_string(place.column);
}

Error input_error(const Place& place, const std::string& what, const std::string& hint) {
  const std::string where = to_string(place);
  const std::string prefix = where.empty() ? "" : where + ": ";
  return {ErrorKind::input, printable(prefix + with_hint(what, hint))};
}

Error usage_error(const std::string& what, const std::string& hint) {
  return {ErrorKind::usage, printable(with_hint(what, hint))};
}

}  // namespace cablefit
