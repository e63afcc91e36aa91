// Motor pulleys whose radius is searched: rig file "motor_radius": {"search": r}.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// A round pulley whose radius is not known; `start`: signed, where its search starts.
DisplacementMap searched_pulley(double start);
bool is_searched(const DisplacementMap& map);

/// Per cable the joint (from 0) on whose motor it has a pulley of unknown radius; a cable has one
/// at most.
using SearchedRadii = std::vector<std::optional<std::size_t>>;
SearchedRadii searched_radii(const Transmission& transmission);
bool searches_radius(const Transmission& transmission);

/// "r_m[left]", as in results.
std::string radius_name(const Cable& cable);

/// Throws Error(input) when the rig searches a motor radius and `who` takes radii as known.
void refuse_searched_radius(const Rig& rig, std::string_view who);

/// A round pulley of this radius, known, on the motor of a joint (from 0); l_o stays that of the
/// reference pose.
void set_motor_radius(Transmission& transmission, std::size_t cable, std::size_t joint,
                      double radius);
/// The same on the link.
void set_link_radius(Transmission& transmission, std::size_t cable, std::size_t joint,
                     double radius);

}  // namespace cablefit
