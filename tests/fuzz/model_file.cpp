// Any text as a model file (cablefit/model/1) or a result of stage 2 (cablefit/dynamic/1); what is
// read can be written, and read again.
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/fuzz/invariant.hpp"

namespace {

cablefit::Model read(std::string_view text) {
  std::string choice;
  return cablefit::parse_model(cablefit::parse_json(text, cablefit::fuzz::kName), "", "", choice);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace cablefit;
  fuzz::succeeds_or_complains([&] {
    const Model model = read(fuzz::as_text(bytes, n_bytes));
    fuzz::require(model.joints.size() == model.rig.joints.size());
    const Model again = read(model_json(model));
    fuzz::require(again.joints.size() == model.joints.size());
  });
  return 0;
}
