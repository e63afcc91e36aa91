// One fit of stage 1 in a result file. Internal to results/.
#pragma once

#include <string_view>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit::result_file {

/// Of "fits" of cablefit/elastic/1. Without a rig its curve, covariance and encoder zeros are left
/// empty: they need its cables.
ElasticFit read_elastic_fit(const JsonNode& node, const Rig* rig);

/// "order" of a fit; 1 where it is missing.
int read_order(const JsonNode& node);

/// What is said where a coefficient is missing, and where.
struct MissingCoefficient {
  const JsonNode* place = nullptr;
  std::string_view hint;
};

/// The curve of fit.model on this rig: coefficients of fit.parameters, encoder zeros of `node`.
void read_curve(const JsonNode& node, const Rig& rig, const MissingCoefficient& missing,
                ElasticFit& fit);

}  // namespace cablefit::result_file
