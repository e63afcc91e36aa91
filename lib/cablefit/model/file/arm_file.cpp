// "arm" of a model file.
#include <algorithm>

#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {

std::vector<Estimate> read_arm(const JsonNode& node, const Rig& rig) {
  if (!rig.arm.is_coupled())
    throw node.error("the rig has no arm whose links are coupled",
                     "give one as \"arm\" in the rig, or each link its \"inertia\"");
  const std::vector<ParameterInfo> infos = rig.arm.base_parameters();
  std::vector<std::string_view> known;
  for (const ParameterInfo& info : infos) known.push_back(info.name);
  for (const auto& [name, value] : members_of(node))
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail_unknown(value, "base parameter", name, known);
  std::vector<Estimate> arm;
  for (const ParameterInfo& info : infos)
    arm.push_back(
        read_strict_estimate(node.at(info.name), std::string(info.name), info.symbol, info.unit));
  return arm;
}

}  // namespace cablefit::model_file
