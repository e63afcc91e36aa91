// Several things can be wrong at once: all are reported, and the gravest decides on the exit code.
#pragma once

#include <optional>
#include <string>

#include "cablefit/base/error.hpp"

namespace cablefit {

class Problems {
 public:
  /// Runs `action`; an Error it throws is kept.
  template <typename Action>
  void collect(Action action) {
    try {
      action();
    } catch (const Error& error) {
      add(error);
    }
  }
  void add(const Error& error);
  /// One Error with all messages, one per line, of the gravest kind.
  void throw_if_any() const;

 private:
  std::optional<ErrorKind> kind_;
  std::string messages_;
};

}  // namespace cablefit
