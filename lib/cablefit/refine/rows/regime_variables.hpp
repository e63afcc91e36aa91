// Variables that residuals are plotted and binned against. Internal to refine/ and report/.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cablefit/base/axes.hpp"
#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

struct RegimeVariable {
  std::string_view regime;       ///< "speed"
  std::string_view link, motor;  ///< its name on either axis: "qd", "thetad"
  std::string_view unit;         ///< of a rotary axis; may be empty
  /// `load`: tau_load.
  double (*value)(const JointState& state, bool link, double load);
};

/// In order: speed, direction, position, deflection, elastic torque, load, time.
std::span<const RegimeVariable> regime_variables();

/// Its value at a sample of a stretch.
double value_at(const RegimeVariable& variable, const Design& design, std::size_t stretch,
                RowKind kind, Eigen::Index sample);

/// The unit of a regime's variable; empty: none.
std::string regime_unit(std::string_view regime, Axes axes);

}  // namespace cablefit
