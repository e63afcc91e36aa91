// Reads cablefit/elastic/1 back: what stage 2 needs of stage 1, from the file it was written to.
#pragma once

#include <string>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// Curves, estimates, covariance, ranges and everything else of the file. The rig of each preload
/// is read from its "rig" path (beside the file or from the current folder), null being the default
/// rig. Throws Error(input) at file:line:column for what is missing or does not fit together.
ElasticResult read_elastic_result(const std::string& path);

class JsonNode;
/// The same from a document that is read already.
ElasticResult parse_elastic_result(const JsonNode& root);

}  // namespace cablefit
