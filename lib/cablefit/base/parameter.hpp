// A parameter: its name, unit and bounds, and its estimate.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// What is not known, or is not there.
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// A row of a table of parameters. `unit` is for a rotary axis; unit_for() gives the others.
struct ParameterInfo {
  std::string_view name;    ///< as in results: "J_link"
  std::string_view symbol;  ///< as in the paper: "J_M"
  std::string_view unit;    ///< "kg m^2"
  std::string_view meaning;
  double lower = -kUnbounded;  ///< physical bound, in SI
  double upper = kUnbounded;
};

/// An estimate with its uncertainty. NaN stands for "none": printed as a dash, null in JSON.
struct Estimate {
  std::string name;
  std::string symbol;
  std::string unit;
  double value = kNotKnown;
  double sd = kNotKnown;        ///< robust, see docs/explanation
  double sd_white = kNotKnown;  ///< the paper's (25)
  double ci_low = kNotKnown;    ///< 95 % interval
  double ci_high = kNotKnown;
  double cad = kNotKnown;        ///< for comparison only, never fitted to
  std::string not_identifiable;  ///< why there is no sd; empty when there is one
  std::string active_bound;      ///< "f_sm >= 0" when that bound holds the estimate
  /// The interval is that of the profile likelihood and need not be symmetric about the value.
  /// Otherwise it is value -+ t sd.
  bool profiled = false;

  /// 100 sd / |value|, NaN when either is missing or the value is 0.
  double rsd_percent() const;
};

/// The parameter of an estimate without a value, and why it has none.
Estimate refused_estimate(const Estimate& of, std::string why);

/// The estimate of that name, or nullptr.
const Estimate* find_estimate(const std::vector<Estimate>& estimates, std::string_view name);

}  // namespace cablefit
