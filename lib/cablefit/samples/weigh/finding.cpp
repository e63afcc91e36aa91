#include "cablefit/samples/weigh/finding.hpp"

#include <fmt/format.h>

#include "cablefit/base/quote.hpp"

namespace cablefit {

std::string weighed_name(const LogPlan& plan, Channel channel, int joint) {
  std::string name(channel_name(channel));
  return plan.rig.n_joints() > 1 ? name + std::to_string(joint + 1) : name;
}

namespace {

std::string column_name(const LogPlan& plan, Channel channel, int joint) {
  const int k = plan.find(channel, joint);
  return k < 0
             ? weighed_name(plan, channel, joint)
             : shortened(plan.header.columns[plan.slots[static_cast<std::size_t>(k)].column].name);
}

}  // namespace

std::string mending_line(const LogPlan& plan, Channel channel, int joint, double factor) {
  const std::string name = weighed_name(plan, channel, joint);
  const auto mapped = plan.rig.columns.find(name);
  const double scale = mapped == plan.rig.columns.end() ? 1 : mapped->second.scale;
  return fmt::format("\"{}\": {{\"column\": \"{}\", \"scale\": {:.4g}}} in the rig file's columns",
                     name, column_name(plan, channel, joint), scale * factor);
}

std::string mending_unit(const LogPlan& plan, Channel channel, int joint, std::string_view unit) {
  return fmt::format("\"{}\": {{\"column\": \"{}\", \"unit\": \"{}\"}} in the rig file's columns",
                     weighed_name(plan, channel, joint), column_name(plan, channel, joint), unit);
}

}  // namespace cablefit
