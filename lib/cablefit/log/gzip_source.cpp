#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "cablefit/log/compression.hpp"

namespace cablefit {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;  // zlib's way of asking for gzip members

class GzipSource final : public ByteSource {
 public:
  GzipSource(std::unique_ptr<ByteSource> packed, std::string path)
      : packed_(std::move(packed)), path_(std::move(path)), block_(kPackedBlockBytes) {
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~GzipSource() override { inflateEnd(&stream_); }
  GzipSource(const GzipSource&) = delete;
  GzipSource& operator=(const GzipSource&) = delete;

  std::size_t read(char* to, std::size_t n_bytes) override {
    constexpr std::size_t kMaxBytes = std::numeric_limits<uInt>::max();
    const auto n_wanted = static_cast<uInt>(std::min(n_bytes, kMaxBytes));
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = n_wanted;
    while (stream_.avail_out == n_wanted && advance()) {
    }
    return n_wanted - stream_.avail_out;
  }

 private:
  /// One call of inflate(); false at the end of the data.
  bool advance() {
    if (stream_.avail_in == 0) refill();
    const bool no_input_left = stream_.avail_in == 0;
    if (no_input_left && !in_member_) return false;
    if (!in_member_) begin_member();
    const uInt n_free = stream_.avail_out;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    const std::size_t n_unpacked = n_free - stream_.avail_out;
    n_good_ += n_unpacked;
    if (status == Z_STREAM_END) in_member_ = false;
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) throw_corrupt();
    if (no_input_left && in_member_ && n_unpacked == 0) {
      throw truncated_error(path_, "gzip", n_good_);
    }
    return true;
  }

  void begin_member() {
    if (n_members_++ > 0) inflateReset(&stream_);
    in_member_ = true;
  }

  void refill() {
    const std::size_t n_read = packed_->read(block_.data(), block_.size());
    stream_.next_in = reinterpret_cast<Bytef*>(block_.data());
    stream_.avail_in = static_cast<uInt>(n_read);
  }

  [[noreturn]] void throw_corrupt() const {
    const std::string_view reason = stream_.msg == nullptr ? "bad data" : stream_.msg;
    const bool is_garbage = n_members_ > 1 && reason == "incorrect header check";
    throw corrupt_error(path_, "gzip", n_good_, is_garbage ? "garbage at its end" : reason);
  }

  std::unique_ptr<ByteSource> packed_;
  std::string path_;
  std::vector<char> block_;
  z_stream stream_{};
  std::size_t n_good_ = 0;
  std::size_t n_members_ = 0;
  bool in_member_ = false;
};

}  // namespace

bool is_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

std::unique_ptr<ByteSource> unpack_gzip(std::unique_ptr<ByteSource> packed, std::string path) {
  return std::make_unique<GzipSource>(std::move(packed), std::move(path));
}

}  // namespace cablefit
