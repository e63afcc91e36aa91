// Which motion would separate two columns of an equation, in words. What a column follows decides
// (model/motion_part.hpp), never its name. After Swevers et al. 1997 (exciting trajectories) and
// Khalil & Dombre 2004, 12.4.
#pragma once

#include <string>

#include "cablefit/model/motion_part.hpp"

namespace cablefit {

/// What a column of an equation follows, and how strong that is in the rows.
struct MotionColumn {
  MotionPart part = MotionPart::several;
  std::string unit = {};  ///< of the column; empty: its size says nothing about the motion
};

/// "move at several speeds, slow and fast (a speed ladder); now 0.5 rad/s rms"; empty when there is
/// nothing to say. `rms_a`, `rms_b`: root mean square of the columns over the rows.
std::string separating_motion(const MotionColumn& a, double rms_a, const MotionColumn& b,
                              double rms_b);

/// The motion that excites a column that is 0: "accelerate". Empty: no advice.
std::string_view exciting_motion(MotionPart part);

/// The motion that brings an sd that is now `relative_sd` of its parameter (1: as large as it)
/// below 10
/// %: "accelerate with 40 rad/s^2 rms or more (now 3.1)", as an sd falls with the size of its
/// column; or "record 4 times as long" where there is nothing to enlarge. Only for relative_sd >
/// 0.1.
std::string stronger_motion(const MotionColumn& column, double rms_now, double relative_sd);
inline constexpr double kWantedRelativeSd = 0.1;

/// "4300", "0.47": two digits, as in advice.
std::string two_digits(double value);

}  // namespace cablefit
