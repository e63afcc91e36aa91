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

SearchedRadii searched_radii(const Transmission& transmission) {
  SearchedRadii searched;
  for (const Cable& cable : transmission.cables) {
    const auto found = std::find_if(cable.motor_map.begin(), cable.motor_map.end(), is_searched);
    searched.emplace_back();
    if (found != cable.motor_map.end())
      searched.back() = static_cast<std::size_t>(found - cable.motor_map.begin());
  }
  return searched;
}

bool searches_radius(const Transmission& transmission) {
  return std::any_of(transmission.cables.begin(), transmission.cables.end(), [](const Cable& c) {
    return std::any_of(c.motor_map.begin(), c.motor_map.end(), is_searched);
  });
}

std::string radius_name(const Cable& cable) { return fmt::format("r_m[{}]", cable.name); }

void refuse_searched_radius(const Rig& rig, std::string_view who) {
  const SearchedRadii searched = searched_radii(rig.transmission);
  for (std::size_t c = 0; c < searched.size(); ++c)
    if (searched[c])
      throw input_error(
          {rig.path, 0, 0},
          fmt::format("{} does not search the motor radius of cable '{}'", who,
                      rig.transmission.cables[c].name),
          "run 'cablefit identify' and take its model, or give the radius that it found");
}

void set_motor_radius(Transmission& transmission, std::size_t cable, std::size_t joint,
                      double radius) {
  transmission.cables[cable].motor_map[joint] = round_pulley(radius);
  set_reference(transmission, transmission.reference);
}

void set_link_radius(Transmission& transmission, std::size_t cable, std::size_t joint,
                     double radius) {
  transmission.cables[cable].link_map[joint] = round_pulley(radius);
  set_reference(transmission, transmission.reference);
}

}  // namespace cablefit
