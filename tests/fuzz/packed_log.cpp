// Any bytes as a log as it stands on disk: gzip or zstd around CSV or JSON, or neither. What is
// unpacked is read up to a bound, as a small file may hold gigabytes.
#include <algorithm>

#include "cablefit/log/byte_source.hpp"
#include "tests/fuzz/log_walk.hpp"

namespace {

using namespace cablefit;

constexpr std::size_t kMaxUnpackedBytes = 1u << 16;

/// The first bytes of another source.
class Bounded final : public ByteSource {
 public:
  explicit Bounded(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}
  std::size_t read(char* to, std::size_t n_bytes) override {
    const std::size_t n_read =
        n_left_ == 0 ? 0 : source_->read(to, std::min(n_bytes, std::max<std::size_t>(1, n_left_)));
    n_left_ -= n_read;
    return n_read;
  }

 private:
  std::unique_ptr<ByteSource> source_;
  std::size_t n_left_ = kMaxUnpackedBytes;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  fuzz::succeeds_or_complains([&] {
    auto source = std::make_unique<MemorySource>(fuzz::as_text(bytes, n_bytes));
    auto text = std::make_unique<Bounded>(unpacked(std::move(source), fuzz::kName));
    fuzz::read_to_the_end(*open_log(std::move(text), fuzz::kName));
  });
  return 0;
}
