#include "cablefit/identify/identify_result.hpp"

#include <algorithm>

namespace cablefit {

bool IdentifyPreload::knows_elongations() const {
  return std::all_of(transmission.cables.begin(), transmission.cables.end(),
                     [&](const Cable& cable) {
                       const Estimate* e = find_estimate(parameters, elongation_name(cable));
                       return e == nullptr || e->not_identifiable.empty();
                     });
}

}  // namespace cablefit
