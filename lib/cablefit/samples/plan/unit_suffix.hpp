// Units at the end of a column's name, as in motor_pos_deg or tau_mNm.
#pragma once

#include <optional>
#include <string_view>

#include "cablefit/base/units.hpp"

namespace cablefit {

/// "motor_pos_deg" is "motor_pos" in "deg".
struct SuffixedName {
  std::string_view stem, unit;
};
/// Empty where the name ends in no unit of the wanted dimension. q_Deg and q_DEG are degrees too;
/// units of one letter need that letter's case, since theta_M may be a motor's.
std::optional<SuffixedName> split_unit_suffix(std::string_view column, const Dimension& wanted);

/// Whether the name ends in _A or _mA: a current, which a torque constant makes a torque.
bool is_current_name(std::string_view column);
bool is_milliampere_name(std::string_view column);
/// "i_q" of "i_q_mA"; empty of a name that is no current's.
std::string_view stem_of_current(std::string_view column);

}  // namespace cablefit
