#include "cablefit/model/rig/searched_radius.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

/// The round pulley under another name: everything that only needs a radius takes the start.
const MapKind& searched_kind() {
  static const MapKind kKind = [] {
    MapKind kind = *round_pulley(1).kind;
    kind.name = "search";
    return kind;
  }();
  return kKind;
}

}  // namespace

DisplacementMap searched_pulley(double start) {
  DisplacementMap map = round_pulley(start);
  map.kind = &searched_kind();
  return map;
}

bool is_searched(const DisplacementMap& map) { return map.kind == &searched_kind(); }

std::vector<bool> searched_radii(const Transmission& transmission) {
  std::vector<bool> searched;
  for (const Cable& cable : transmission.cables)
    searched.push_back(is_searched(cable.motor_map.front()));
  return searched;
}

bool searches_radius(const Transmission& transmission) {
  return std::any_of(transmission.cables.begin(), transmission.cables.end(),
                     [](const Cable& cable) { return is_searched(cable.motor_map.front()); });
}

std::string radius_name(const Cable& cable) { return fmt::format("r_m[{}]", cable.name); }

void refuse_searched_radius(const Rig& rig, std::string_view who) {
  for (const Cable& cable : rig.transmission.cables)
    if (is_searched(cable.motor_map.front()))
      throw input_error(
          {rig.path, 0, 0},
          fmt::format("{} does not search the motor radius of cable '{}'", who, cable.name),
          "run 'cablefit identify' and take its model, or give the radius that it found");
}

void set_motor_radius(Transmission& transmission, std::size_t cable, double radius) {
  transmission.cables[cable].motor_map = {round_pulley(radius)};
  set_reference(transmission, transmission.reference);
}

}  // namespace cablefit
