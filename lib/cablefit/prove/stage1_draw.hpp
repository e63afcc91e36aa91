// Stage 1 as it might have come out. Internal to prove/.
#pragma once

#include "cablefit/base/random.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// The result with the fit of that preload and model drawn from a normal distribution about `truth`
/// with its robust covariance.
ElasticResult draw_stage1(const ElasticResult& result, const std::string& preload,
                          const ElasticFit& truth, Random& random);

}  // namespace cablefit
