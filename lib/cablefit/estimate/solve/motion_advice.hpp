// Advice in words: the motion that would separate two columns of an equation. The part of the
// motion that a column follows decides (model/motion_part.hpp), never the column's name. After
// Swevers et al. 1997 (exciting trajectories) and Khalil & Dombre 2004, 12.4.
#pragma once

#include <string>

#include "cablefit/model/motion_part.hpp"

namespace cablefit {

/// The part of the motion that a column of an equation follows, and the column's unit.
struct MotionColumn {
  MotionPart part = MotionPart::several;
  std::string unit = {};  ///< of the column; empty: its size does not describe the motion
};

/// "move at several speeds, slow and fast (a speed ladder); now 0.5 rad/s rms"; empty when there is
/// no advice. `rms_a`, `rms_b`: root mean square of the columns over the rows.
std::string separating_motion(const MotionColumn& a, double rms_a, const MotionColumn& b,
                              double rms_b);

/// The motion that excites a column that is 0: "accelerate". Empty: no advice.
std::string_view exciting_motion(MotionPart part);

/// The motion that reduces `relative_sd`, the sd of a parameter relative to it, to less than 10 %.
/// "accelerate with 40 rad/s^2 rms or more (now 3.1)": an sd falls with the size of its column.
/// Where no column can be enlarged: "record 4 times as long". Only for relative_sd > 0.1.
std::string stronger_motion(const MotionColumn& column, double rms_now, double relative_sd);
inline constexpr double kWantedRelativeSd = 0.1;

/// "4300", "0.47": two digits, as in advice.
std::string two_digits(double value);

}  // namespace cablefit
