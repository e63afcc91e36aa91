// Reads cablefit/elastic/1 back: what stage 2 needs of stage 1, from the file it was written to.
#pragma once

#include <string>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

class JsonNode;

/// Whether the rig files that a result names are read. Without them curves and effects, which need
/// the rig's cables, are left empty: enough to compare estimates, wherever the rig files are.
enum class RigFiles { read, leave };

/// Curves, estimates, covariance, ranges and everything else of the file, but for figures, scores
/// and the comparison of bases. The rig of each preload is read from its "rig" path (beside the
/// file or from the current folder), null being the default rig. Throws Error(input) at
/// file:line:column for what is missing or does not fit together.
ElasticResult read_elastic_result(const std::string& path);
/// The same from a document that is read already.
ElasticResult parse_elastic_result(const JsonNode& root, RigFiles rig_files = RigFiles::read);

}  // namespace cablefit
