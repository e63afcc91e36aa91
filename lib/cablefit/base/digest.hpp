// SHA-256 of input files, so that a result says exactly which bytes it came from.
#pragma once

#include <string>
#include <string_view>

namespace cablefit {

/// Hex digest of the bytes of a file, read in blocks. Throws Error(input) when it cannot be read.
std::string sha256_of_file(const std::string& path);
std::string sha256_of_text(std::string_view text);

}  // namespace cablefit
