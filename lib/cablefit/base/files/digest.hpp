// SHA-256 of input files, so that a result identifies the bytes it was made from.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace cablefit {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);
  /// Digest of all bytes added. Call it once, at the end.
  std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Hex digest of the bytes of a file, read in blocks. Throws Error(input) when it cannot be read.
std::string sha256_of_file(const std::string& path);
std::string sha256_of_text(std::string_view text);

}  // namespace cablefit
