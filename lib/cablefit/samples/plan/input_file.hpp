// The record of a log in a result.
#pragma once

#include <string>

namespace cablefit {

struct InputFile {
  std::string path;
  std::string sha256;
  std::size_t rows = 0;
};

}  // namespace cablefit
