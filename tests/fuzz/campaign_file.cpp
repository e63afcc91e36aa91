// Any text as a campaign (cablefit/campaign/1); every path in it is taken to exist.
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/campaign/campaign.hpp"
#include "tests/fuzz/invariant.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace cablefit;
  fuzz::succeeds_or_complains([&] {
    const auto itself = [](const std::string& pattern) {
      return pattern.empty() ? std::vector<std::string>{} : std::vector{pattern};
    };
    const Campaign campaign =
        parse_campaign(parse_json(fuzz::as_text(bytes, n_bytes), fuzz::kName), itself);
    fuzz::require(!campaign.cells.empty() && !campaign.models.empty());
    for (const CampaignCell& cell : campaign.cells) fuzz::require(!cell.blocked.empty());
  });
  return 0;
}
