#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

std::string with_hint(const std::string& what, const std::string& hint) {
  return hint.empty() ? what : what + "; " + hint;
}

}  // namespace

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
  return {ErrorKind::input, prefix + with_hint(what, hint)};
}

Error usage_error(const std::string& what, const std::string& hint) {
  return {ErrorKind::usage, with_hint(what, hint)};
}

}  // namespace cablefit
