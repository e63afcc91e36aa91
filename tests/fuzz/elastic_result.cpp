// Any text as a result of stage 1 (cablefit/elastic/1), as stage 2 reads it back.
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "tests/fuzz/invariant.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace cablefit;
  fuzz::succeeds_or_complains([&] {
    const ElasticResult result =
        parse_elastic_result(parse_json(fuzz::as_text(bytes, n_bytes), fuzz::kName));
    for (const ElasticPreload& preload : result.preloads) {
      const ElasticFit* selected = preload.find(preload.selected);
      fuzz::require(selected != nullptr);
      fuzz::require(selected->covariance.rows() == selected->covariance.cols());
    }
  });
  return 0;
}
