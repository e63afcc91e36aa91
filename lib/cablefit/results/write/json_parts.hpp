// What all result files have in common. Internal to results/.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit::result_json {

using Json = nlohmann::ordered_json;

/// schema, cablefit_version, command, inputs, warnings.
Json header(std::string_view command, const std::vector<InputFile>& inputs,
            const std::vector<std::string>& warnings);

Json parameters(const std::vector<Estimate>& estimates);
Json decisions(const std::vector<Decision>& decisions);
Json window_counts(const WindowCounts& counts);
Json row_counts(const RowCounts& counts);
Json text_or_null(const std::string& text);
/// The path of a rig file, null for the default rig.
Json rig(const std::string& path);
/// Whether all joints slide: true, false, "mixed".
Json linear_motion(Axes axes);
/// One number, or a list when there are several joints.
Json per_joint(const Eigen::VectorXd& values);
/// Per cable the coefficients of the fitted curve, where some are not identifiable and so have no
/// value of their own; null: all have one.
Json curve_coefficients(const ElasticFit& fit);
/// The drive's offset, or a list of several joints', null where there is none.
Json offset(const ElasticFit& fit);

/// Two blanks per level; whatever fits on a line stands on one. Numbers in the shortest form that
/// reads back as the same bits; NaN and infinities are null, bytes that are no UTF-8 are replaced.
std::string text(const Json& json);

}  // namespace cablefit::result_json
