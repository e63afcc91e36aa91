// Motor pulleys whose radius is searched: rig file "motor_radius": {"search": r}.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// A round pulley whose radius is not known; `start`: signed, where its search starts.
DisplacementMap searched_pulley(double start);
bool is_searched(const DisplacementMap& map);

/// Per cable, of a rig of one joint: the radius of its motor pulley is searched.
std::vector<bool> searched_radii(const Transmission& transmission);
bool searches_radius(const Transmission& transmission);

/// "r_m[left]", as in results.
std::string radius_name(const Cable& cable);

/// Throws Error(input) when the rig searches a motor radius and `who` takes radii as known.
void refuse_searched_radius(const Rig& rig, std::string_view who);

/// A round motor pulley of this radius, known; l_o stays that of the reference pose.
void set_motor_radius(Transmission& transmission, std::size_t cable, double radius);

}  // namespace cablefit
