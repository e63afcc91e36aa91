#include "cablefit/log/byte_source.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "cablefit/base/files/input_file.hpp"
#include "cablefit/log/compression.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMagicBytes = 4;

constexpr std::array kCompressions{
    Compression{"gzip", is_gzip, unpack_gzip},
    Compression{"zstd", is_zstd, unpack_zstd},
};

class FileSource final : public ByteSource {
 public:
  FileSource(const std::string& path, Sha256* digest) : file_(path), digest_(digest) {}
  std::size_t read(char* to, std::size_t n_bytes) override {
    const std::size_t n_read = file_.read(to, n_bytes);
    if (digest_ != nullptr) digest_->add({to, n_read});
    return n_read;
  }

 private:
  FileReader file_;
  Sha256* digest_;
};

}  // namespace

std::size_t MemorySource::read(char* to, std::size_t n_bytes) {
  const std::size_t n_copied = bytes_.copy(to, n_bytes);
  bytes_.remove_prefix(n_copied);
  return n_copied;
}

std::string_view PeekableSource::peek(std::size_t n_bytes) {
  std::size_t n_held = head_.size();
  head_.resize(std::max(n_bytes, n_held));
  while (n_held < n_bytes) {
    const std::size_t n_read = source_->read(head_.data() + n_held, n_bytes - n_held);
    if (n_read == 0) break;
    n_held += n_read;
  }
  head_.resize(n_held);
  return {head_.data(), std::min(n_bytes, n_held)};
}

std::size_t PeekableSource::read(char* to, std::size_t n_bytes) {
  if (n_taken_ == head_.size()) return source_->read(to, n_bytes);
  const std::size_t n_copied = std::min(n_bytes, head_.size() - n_taken_);
  std::copy_n(head_.data() + n_taken_, n_copied, to);
  n_taken_ += n_copied;
  return n_copied;
}

std::span<const Compression> compressions() { return kCompressions; }

std::unique_ptr<PeekableSource> open_bytes(const std::string& path, Sha256* digest) {
  return unpacked(std::make_unique<FileSource>(path, digest), path);
}

std::unique_ptr<PeekableSource> unpacked(std::unique_ptr<ByteSource> bytes,
                                         const std::string& path) {
  auto packed = std::make_unique<PeekableSource>(std::move(bytes));
  const std::string_view magic = packed->peek(kMagicBytes);
  for (const Compression& compression : kCompressions) {
    if (!compression.recognises(magic)) continue;
    return std::make_unique<PeekableSource>(compression.unpack(std::move(packed), path));
  }
  return packed;
}

}  // namespace cablefit
