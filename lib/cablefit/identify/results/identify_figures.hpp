// The one-step identification as plots: the likelihood of each l_o.
#pragma once

#include <span>
#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/identify/identify_result.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Of each preload the cables and where they are slack over the positions of its logs; of each
/// profile its curve.
std::vector<Figure> identify_figures(std::span<const LogSurvey> logs, const IdentifyResult& result);

}  // namespace cablefit
