// Any text as a rig file (cablefit/rig/1).
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"
#include "tests/fuzz/invariant.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace cablefit;
  fuzz::succeeds_or_complains([&] {
    const Rig rig = parse_rig(parse_json(fuzz::as_text(bytes, n_bytes), fuzz::kName));
    fuzz::require(!rig.joints.empty() && !rig.transmission.cables.empty());
    fuzz::require(rig.transmission.cables.size() == rig.search_elongation.size());
  });
  return 0;
}
