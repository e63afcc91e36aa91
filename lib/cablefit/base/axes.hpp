// How the joints of a rig move, which gives the units of angles and torques: SI, rad and N m of a
// joint that turns, m and N of one that slides. Names of quantities are the same for both.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

enum class Axes { rotary, linear, mixed };

/// "rotary", "linear", "mixed".
std::string_view to_string(Axes axes);

/// The unit of a quantity by its unit on joints that turn: "kg m^2" is "kg" on joints that slide,
/// "N m/rad" is "N/m". Of a rig with both, "kg m^2 or kg".
std::string unit_for(Axes axes, std::string_view rotary_unit);

/// Of every joint of a rig, rotary or linear.
class JointAxes {
 public:
  explicit JointAxes(std::vector<Axes> joints = {Axes::rotary}) : joints_(std::move(joints)) {}

  /// `joint` from 0.
  Axes of(int joint) const { return joints_[static_cast<std::size_t>(joint)]; }
  Axes all() const;
  bool operator==(const JointAxes&) const = default;

 private:
  std::vector<Axes> joints_;
};

inline std::string torque_unit(Axes axes) { return unit_for(axes, "N m"); }

/// Those of the first of some results, which are all of one rig or of rigs with the same axes.
template <typename Results>
Axes axes_of(const Results& results) {
  return results.empty() ? Axes::rotary : results.front().axes;
}

}  // namespace cablefit
