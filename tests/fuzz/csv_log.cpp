// Any text as a CSV log, cut into blocks of a length that goes by the text's: cells and lines end
// up across two blocks in many ways.
#include "cablefit/log/csv_reader.hpp"
#include "tests/fuzz/log_walk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace cablefit;
  fuzz::succeeds_or_complains([&] {
    const std::size_t block_bytes = 16 + n_bytes % 61;
    auto source = std::make_unique<MemorySource>(fuzz::as_text(bytes, n_bytes));
    fuzz::read_to_the_end(*open_csv(std::move(source), fuzz::kName, {}, block_bytes));
  });
  return 0;
}
