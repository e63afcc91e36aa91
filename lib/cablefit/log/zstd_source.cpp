#include <zstd.h>

#include <new>
#include <utility>
#include <vector>

#include "cablefit/log/compression.hpp"

namespace cablefit {
namespace {

constexpr int kMaxWindowLog = 27;  // 128 MiB

class ZstdSource final : public ByteSource {
 public:
  ZstdSource(std::unique_ptr<ByteSource> packed, std::string path)
      : packed_(std::move(packed)), path_(std::move(path)), block_(kPackedBlockBytes) {
    if (!context_) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  }

  std::size_t read(char* to, std::size_t n_bytes) override {
    ZSTD_outBuffer output{to, n_bytes, 0};
    while (output.pos == 0 && advance(output)) {
    }
    return output.pos;
  }

 private:
  /// One call of the decompressor; false at the end of the data.
  bool advance(ZSTD_outBuffer& output) {
    // A full output may have left unpacked bytes inside the context: those come first. Otherwise a
    // call without input would begin a new frame.
    if (input_.pos == input_.size && !was_full_) refill();
    if (input_.size == 0 && !was_full_) {
      if (in_frame_) throw truncated_error(path_, "zstd", n_good_);
      return false;
    }
    const std::size_t n_before = output.pos;
    const std::size_t status = ZSTD_decompressStream(context_.get(), &output, &input_);
    n_good_ += output.pos - n_before;
    if (ZSTD_isError(status)) {
      throw corrupt_error(path_, "zstd", n_good_, ZSTD_getErrorName(status));
    }
    in_frame_ = status != 0;
    was_full_ = in_frame_ && output.pos == output.size;
    return true;
  }

  void refill() { input_ = {block_.data(), packed_->read(block_.data(), block_.size()), 0}; }

  std::unique_ptr<ByteSource> packed_;
  std::string path_;
  std::vector<char> block_;
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_{ZSTD_createDCtx(), &ZSTD_freeDCtx};
  ZSTD_inBuffer input_{nullptr, 0, 0};
  std::size_t n_good_ = 0;
  bool in_frame_ = false;
  bool was_full_ = false;
};

}  // namespace

// A data frame, or a skippable one as pzstd writes before it.
bool is_zstd(std::string_view head) {
  const bool is_skippable = head.size() >= 4 && head.substr(1, 3) == "\x2a\x4d\x18" &&
                            (static_cast<unsigned char>(head[0]) & 0xF0u) == 0x50u;
  return is_skippable || head.starts_with("\x28\xb5\x2f\xfd");
}

std::unique_ptr<ByteSource> unpack_zstd(std::unique_ptr<ByteSource> packed, std::string path) {
  return std::make_unique<ZstdSource>(std::move(packed), std::move(path));
}

}  // namespace cablefit
