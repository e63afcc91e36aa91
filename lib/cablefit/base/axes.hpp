// How the joints of a rig move, which gives the units of angles and torques: SI, rad and N m of a
// joint that turns, m and N of one that slides. Names of quantities are the same for both.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

/// In mrad or mm, as tables and plots show deflections.
inline constexpr double kMilli = 1e3;

enum class Axes { rotary, linear, mixed };

/// "rotary", "linear", "mixed".
std::string_view to_string(Axes axes);

/// The unit of a quantity by its unit on joints that turn: "kg m^2" is "kg" on joints that slide,
/// "N m/rad" is "N/m". Of a rig with both, "kg m^2 or kg".
std::string unit_for(Axes axes, std::string_view rotary_unit);

/// Of every joint of a rig, rotary or linear; by default all turn.
class JointAxes {
 public:
  JointAxes() = default;
  /// One per joint.
  explicit JointAxes(std::vector<Axes> joints);

  /// `joint` from 0.
  Axes of(int joint) const {
    return joints_.empty() ? all_ : joints_[static_cast<std::size_t>(joint)];
  }
  Axes all() const { return all_; }
  bool operator==(const JointAxes&) const = default;

 private:
  Axes all_ = Axes::rotary;
  std::vector<Axes> joints_;  ///< where they differ
};

inline std::string torque_unit(Axes axes) { return unit_for(axes, "N m"); }

/// Those of the first of some results, which are all of one rig or of rigs with the same axes.
template <typename Results>
Axes axes_of(const Results& results) {
  return results.empty() ? Axes::rotary : results.front().axes;
}

}  // namespace cablefit
