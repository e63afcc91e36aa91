// Any text as a JSON log: channels and records.
#include "cablefit/log/json/json_reader.hpp"
#include "tests/fuzz/log_walk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace cablefit;
  fuzz::succeeds_or_complains([&] {
    auto source = std::make_unique<MemorySource>(fuzz::as_text(bytes, n_bytes));
    fuzz::read_to_the_end(*open_json(std::move(source), fuzz::kName, {}));
  });
  return 0;
}
