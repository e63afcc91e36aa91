#include <algorithm>

#include "cablefit/model/load/laws.hpp"

namespace cablefit::laws {
namespace {

LoadParameters read(const JsonNode& node) {
  node.allow_only({"type", "q", "torque"});
  LoadParameters parameters;
  parameters.q = node.at("q").numbers();
  parameters.table_torque = node.at("torque").numbers();
  if (parameters.q.size() < 2) {
    throw node.at("q").error("a table needs at least two points", "give q and torque as lists");
  }
  if (parameters.q.size() != parameters.table_torque.size()) {
    throw node.at("torque").error("q and torque have different lengths", "one torque per q");
  }
  const auto step_back = std::adjacent_find(parameters.q.begin(), parameters.q.end(),
                                            [](double a, double b) { return !(a < b); });
  if (step_back != parameters.q.end()) {
    const auto at = static_cast<std::size_t>(step_back - parameters.q.begin()) + 1;
    throw node.at("q").items[at].error("q must ascend", "sort the points by q");
  }
  return parameters;
}

std::vector<LoadEntry> entries(const LoadParameters& p) {
  return {{"q", p.q}, {"torque", p.table_torque}};
}

double torque(const LoadParameters& p, double q) {
  const auto above = std::upper_bound(p.q.begin(), p.q.end(), q);
  if (above == p.q.begin()) return p.table_torque.front();
  if (above == p.q.end()) return p.table_torque.back();
  const auto i = static_cast<std::size_t>(above - p.q.begin());
  const double fraction = (q - p.q[i - 1]) / (p.q[i] - p.q[i - 1]);
  return p.table_torque[i - 1] + fraction * (p.table_torque[i] - p.table_torque[i - 1]);
}

double slope(const LoadParameters& p, double q) {
  const auto above = std::upper_bound(p.q.begin(), p.q.end(), q);
  if (above == p.q.begin() || above == p.q.end()) return 0.0;
  const auto i = static_cast<std::size_t>(above - p.q.begin());
  return (p.table_torque[i] - p.table_torque[i - 1]) / (p.q[i] - p.q[i - 1]);
}

double inertia(const LoadParameters& /*parameters*/) { return 0.0; }

}  // namespace

LoadLaw table() {
  return {.name = "table",
          .equation = "tau_load(q), linear between points, constant outside",
          .from_column = false,
          .read = read,
          .entries = entries,
          .torque = torque,
          .inertia = inertia,
          .any_joints = false,
          .rotary_only = false,
          .free_fall = nullptr,
          .slope = slope};
}

}  // namespace cablefit::laws
