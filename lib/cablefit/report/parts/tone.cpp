#include <algorithm>
#include <array>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {
namespace {

/// Verdicts that are not grey, by their first words.
struct KnownVerdict {
  std::string_view begins;
  Tone tone;
};

constexpr std::array kKnown{
    KnownVerdict{"passed", Tone::good},         KnownVerdict{"FAILED", Tone::bad},
    KnownVerdict{"equal", Tone::good},          KnownVerdict{"different, within", Tone::neutral},
    KnownVerdict{"different", Tone::bad},       KnownVerdict{"identifiable", Tone::good},
    KnownVerdict{"not identifiable", Tone::bad}};

}  // namespace

Tone tone_of(std::string_view verdict) {
  const auto found = std::find_if(kKnown.begin(), kKnown.end(), [&](const KnownVerdict& known) {
    return verdict.starts_with(known.begins);
  });
  return found == kKnown.end() ? Tone::neutral : found->tone;
}

}  // namespace cablefit
