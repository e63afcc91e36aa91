#include "cablefit/base/files/digest.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include "cablefit/base/files/input_file.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kBlockBytes = 1u << 18;

// No input can make these calls fail, only a broken library.
void require(int status) {
  if (status != 1) throw std::runtime_error("libcrypto offers no SHA-256");
}

}  // namespace

struct Sha256::Context {
  EVP_MD_CTX* state = EVP_MD_CTX_new();
  Context() = default;
  ~Context() { EVP_MD_CTX_free(state); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  require(EVP_DigestInit_ex(context_->state, EVP_sha256(), nullptr));
}

Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  require(EVP_DigestUpdate(context_->state, bytes.data(), bytes.size()));
}

std::string Sha256::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int n_bytes = 0;
  require(EVP_DigestFinal_ex(context_->state, digest.data(), &n_bytes));
  std::string text;
  for (unsigned int i = 0; i < n_bytes; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

std::string sha256_of_file(const std::string& path) {
  FileReader file(path);
  Sha256 sha256;
  std::vector<char> block(kBlockBytes);
  while (const std::size_t n_read = file.read(block.data(), block.size())) {
    sha256.add({block.data(), n_read});
  }
  return sha256.hex();
}

std::string sha256_of_text(std::string_view text) {
  Sha256 sha256;
  sha256.add(text);
  return sha256.hex();
}

}  // namespace cablefit
