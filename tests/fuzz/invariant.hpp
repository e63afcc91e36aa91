// What every reader of files promises, whatever bytes it meets: it succeeds, or it throws one Error
// that names the place. A target of libFuzzer is one file that feeds bytes to one reader through
// this; anything else that it throws ends the run as a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "cablefit/base/error.hpp"

namespace cablefit::fuzz {

/// Where libFuzzer's bytes came from, for messages.
inline const std::string kName = "fuzzed";

/// Ends the run: `claim` was false of an input.
inline void require(bool claim) {
  if (!claim) std::abort();
}

inline bool is_printable(std::string_view message) {
  for (const char c : message) {
    if ((c >= 0 && c < 0x20 && c != '\n') || c == 0x7F) return false;
  }
  return true;
}

template <typename Action>
void succeeds_or_complains(Action action) {
  try {
    action();
  } catch (const Error& error) {
    const std::string_view message = error.what();
    require(error.kind() == ErrorKind::input);
    require(message.starts_with(kName) && message.size() > kName.size() + 2);
    require(is_printable(message));
  }
}

inline std::string_view as_text(const std::uint8_t* bytes, std::size_t n_bytes) {
  return {reinterpret_cast<const char*>(bytes), n_bytes};
}

}  // namespace cablefit::fuzz
