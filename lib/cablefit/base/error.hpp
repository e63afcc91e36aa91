// The one exception class of cablefit. A user's mistake throws it, and main catches it once. Its
// kind is the exit code (docs/reference/exit-codes.md): 2 usage, 3 bad input, 4 not identifiable, 5
// could not write.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace cablefit {

enum class ErrorKind { usage = 2, input = 3, not_identifiable = 4, output = 5 };

/// A place in a text file. Line and column count from 1; 0 means "not known" and is not printed.
struct Place {
  std::string file;
  std::size_t line = 0;
  std::size_t column = 0;
};

/// "file:line:column", without the parts that are not known.
std::string to_string(const Place& place);

/// Its message is printable: control characters in names from files are escaped. Only line breaks
/// stay, because an Error may hold several messages, one below the other.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message);
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// "file:line:column: what; hint" as an input error (exit code 3). `hint` says what to do.
Error input_error(const Place& place, const std::string& what, const std::string& hint);
/// A mistake on the command line (exit code 2).
Error usage_error(const std::string& what, const std::string& hint);

}  // namespace cablefit
