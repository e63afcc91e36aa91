// Which estimates of two results stand for the same thing. Internal to campaign/.
#pragma once

#include <vector>

#include "cablefit/campaign/compare/compare.hpp"

namespace cablefit {

struct EstimatePair {
  const EstimateSet *first_set = nullptr, *second_set = nullptr;
  const Estimate *first = nullptr, *second = nullptr;
};

/// In the order of the first result; they point into both. What only one of them has is added to
/// `alone`. Throws Error(usage) for a preload or model that is not there.
std::vector<EstimatePair> estimate_pairs(const RecordedResult& first, const RecordedResult& second,
                                         const CompareOptions& options,
                                         std::vector<Uncompared>& alone);

/// Zero is what a good rig would have (an offset, an encoder's zero), so that a share of the value
/// says nothing.
bool is_ideally_zero(std::string_view name);

/// What such a parameter is measured by, NaN when the set does not say.
double scale_of_zero(const EstimateSet& set, const Estimate& estimate);

}  // namespace cablefit
