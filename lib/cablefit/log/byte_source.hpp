// The bytes of a log, unpacked. gzip and zstd are recognised by their first bytes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cablefit/base/files/digest.hpp"

namespace cablefit {

class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Up to `n_bytes` (> 0) bytes, 0 only at the end. Throws Error(input) for a read error and for
  /// corrupt or truncated compressed data.
  virtual std::size_t read(char* to, std::size_t n_bytes) = 0;
};

/// Bytes that are in memory already and stay there as long as this.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string_view bytes) : bytes_(bytes) {}
  std::size_t read(char* to, std::size_t n_bytes) override;

 private:
  std::string_view bytes_;
};

/// Looks at the first bytes of another source without taking them.
class PeekableSource final : public ByteSource {
 public:
  explicit PeekableSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}
  /// The first `n_bytes` bytes, fewer when there are no more. Only before the first read().
  std::string_view peek(std::size_t n_bytes);
  std::size_t read(char* to, std::size_t n_bytes) override;

 private:
  std::unique_ptr<ByteSource> source_;
  std::vector<char> head_;
  std::size_t n_taken_ = 0;  // of head_
};

/// A row of the table of compressions.
struct Compression {
  std::string_view name;
  bool (*recognises)(std::string_view head);
  /// `path` is for messages.
  std::unique_ptr<ByteSource> (*unpack)(std::unique_ptr<ByteSource> packed, std::string path);
};
std::span<const Compression> compressions();

/// Opens a file and unpacks it when a row of the table recognises it. `digest`, which must outlive
/// the source, sees every byte of the file as it is read; null: nobody wants it.
std::unique_ptr<PeekableSource> open_bytes(const std::string& path, Sha256* digest = nullptr);
/// The same from bytes that are open already; `path` is for messages.
std::unique_ptr<PeekableSource> unpacked(std::unique_ptr<ByteSource> bytes,
                                         const std::string& path);

}  // namespace cablefit
