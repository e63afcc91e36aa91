#include "cablefit/model/refinements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/model/refinements/rows.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostOwn = 64;  // rows stay where they are: models point to them

std::vector<Refinement> shipped_rows() {
  using namespace rows;
  using enum Site;
  return {
      constant_torque(),
      asymmetric_coulomb(link),
      asymmetric_coulomb(motor),
      gravity_imbalance(),
      asymmetric_viscous(link),
      asymmetric_viscous(motor),
      stribeck(link),
      stribeck(motor),
      quadratic_drag(link),
      quadratic_drag(motor),
      nonlinear_viscous(link),
      nonlinear_viscous(motor),
      position_friction(link),
      position_friction(motor),
      tension_friction(link),
      tension_friction(motor),
      presliding(link),
      presliding(motor),
      friction_drift(link),
      friction_drift(motor),
      load_friction(),
      cogging(),
      drive_efficiency(),
      cable_damping(),
      cable_hysteresis(),
      stiffness_order(),
      stiffness_asymmetry(),
      pulley_eccentricity(),
      creep(),
      dead_zone(),
      rows::preload(),
      encoder_scale(),
      encoder_offset(),
      encoder_delay(),
      torque_delay(),
      offset_drift(),
      torque_gain(),
      load_scale(),
      saturation(),
      drive_dead_band(),
      slip(),
      contact(),
      payload_change(),
  };
}

std::vector<Refinement>& table() {
  static std::vector<Refinement> all = [] {
    std::vector<Refinement> rows = shipped_rows();
    rows.reserve(rows.size() + kMostOwn);
    return rows;
  }();
  return all;
}

}  // namespace

std::string_view to_string(Site site) {
  static constexpr std::array<std::string_view, 5> kNames{"link", "motor", "transmission", "sensor",
                                                          "drive"};
  return kNames.at(static_cast<std::size_t>(site));
}

double ShapeGrid::value(int i, const LogScale& scale) const {
  assert(i >= 0 && i < n_values);
  const double share = n_values > 1 ? static_cast<double>(i) / (n_values - 1) : 0.5;
  const double from = lowest(scale), to = highest(scale);
  if (!is_geometric) return from + share * (to - from);
  return from * std::pow(to / from, share);
}

double ShapeGrid::lowest(const LogScale& scale) const {
  const double plain = low * factor(scale);
  return is_rare ? std::min(std::max(plain, scale.usual), highest(scale)) : plain;
}

double ShapeGrid::factor(const LogScale& scale) const {
  switch (unit) {
    case GridUnit::si:
      return 1;
    case GridUnit::peak:
      return scale.peak;
    case GridUnit::per_travel:
      return 1 / scale.travel;
    case GridUnit::speed:
      return scale.speed;
    case GridUnit::deflection:
      return scale.deflection;
  }
  return 1;
}

std::span<const Refinement> refinements() { return table(); }

void add_effect(const Refinement& row) {
  std::vector<Refinement>& all = table();
  const bool is_there = std::any_of(all.begin(), all.end(), [&](const Refinement& other) {
    return other.name == row.name && other.site == row.site;
  });
  if (is_there)
    throw usage_error(fmt::format("effect '{}' of the {} exists", row.name, to_string(row.site)),
                      "give yours another name");
  if (all.size() == all.capacity())
    throw usage_error(fmt::format("more than {} effects of your own", kMostOwn), "drop some");
  all.push_back(row);
}

const Refinement& find_refinement(std::string_view name, Site site) {
  std::vector<std::string_view> known, elsewhere;
  for (const Refinement& row : refinements()) {
    if (row.name == name && row.site == site) return row;
    if (row.name == name) elsewhere.push_back(to_string(row.site));
    if (row.site == site) known.push_back(row.name);
  }
  throw input_error({}, fmt::format("unknown refinement '{}' of the {}", name, to_string(site)),
                    elsewhere.empty()
                        ? suggestion(name, known)
                        : fmt::format("there is one of: {}", fmt::join(elsewhere, ", ")));
}

}  // namespace cablefit
