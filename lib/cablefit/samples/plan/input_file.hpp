// A log as a result records it.
#pragma once

#include <string>

namespace cablefit {

struct InputFile {
  std::string path;
  std::string sha256;
  std::size_t rows = 0;
};

}  // namespace cablefit
