#include "cablefit/model/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/model/catalogue/rows.hpp"

namespace cablefit {
namespace rows {
namespace {

std::vector<Effect> candidates() {
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
      path_friction(),
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
      preload(),
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

}  // namespace
}  // namespace rows

namespace {

constexpr std::size_t kMostOwn = 64;  // rows stay where they are: models point to them

std::vector<Effect>& effect_rows() {
  static std::vector<Effect> all = [] {
    const std::vector<Effect> more = rows::candidates();
    std::vector<Effect> rows = rows::base();
    rows.reserve(rows.size() + more.size() + kMostOwn);
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
  }();
  return all;
}

std::size_t n_base() {
  static const std::size_t n = rows::base().size();
  return n;
}

const Eigen::Ref<const Eigen::ArrayXd>& part_of(const Motion& motion, MotionPart part) {
  switch (part) {
    case MotionPart::direction:
      return motion.direction;
    case MotionPart::velocity:
      return motion.velocity;
    case MotionPart::acceleration:
      return motion.acceleration;
    default:
      assert(part == MotionPart::position);
      return motion.position;
  }
}

}  // namespace

std::string_view to_string(Side side) { return to_string(site_of(side)); }

std::string_view to_string(Site site) {
  static constexpr std::array<std::string_view, 6> kNames{"link",   "motor", "transmission",
                                                          "sensor", "drive", "rigid"};
  return kNames.at(static_cast<std::size_t>(site));
}

Site site_of(Side side) {
  return side == Side::link ? Site::link : side == Side::motor ? Site::motor : Site::rigid;
}

double ShapeGrid::value(int i, const LogScale& scale) const {
  assert(i >= 0 && i < n_values);
  const double share = n_values > 1 ? static_cast<double>(i) / (n_values - 1) : 0.5;
  const double from = lowest(scale), to = grid_end(scale);
  if (!is_geometric) return from + share * (to - from);
  return from * std::pow(to / from, share);
}

double ShapeGrid::lowest(const LogScale& scale) const {
  const double plain = low * factor(scale);
  return is_rare ? std::min(std::max(plain, scale.usual), grid_end(scale)) : plain;
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

std::span<const Effect> effects() { return effect_rows(); }

std::span<const Effect> base_effects() { return effects().first(n_base()); }

std::span<const Effect> base_effects(Side side) {
  const auto base = base_effects();
  const auto on_side = [site = site_of(side)](const Effect& row) { return row.site == site; };
  const auto begin = std::find_if(base.begin(), base.end(), on_side);
  return {begin, std::find_if_not(begin, base.end(), on_side)};
}

std::span<const Effect> candidate_effects() { return effects().subspan(n_base()); }

std::span<const Effect> rig_errors() {
  static const std::vector<Effect> rows = rows::rig_errors();
  return rows;
}

namespace {

/// What a row of one's own has to be: one group of functions, and not of the base model.
void require_candidate(const Effect& row) {
  const int kinds = static_cast<int>(row.torque != nullptr || row.level != nullptr) +
                    static_cast<int>(row.correct != nullptr) +
                    static_cast<int>(row.change != nullptr);
  if (kinds != 1)
    throw usage_error(fmt::format("effect '{}' has {} kinds of functions", row.name, kinds),
                      "give torque or level (or both), or correct, or change");
  if (row.is_base() || row.site == Site::rigid)
    throw usage_error(fmt::format("effect '{}' would be of the base model", row.name),
                      "leave `follows` alone; on a rigid drive effects of the motor act");
}

}  // namespace

void add_effect(const Effect& row) {
  require_candidate(row);
  std::vector<Effect>& all = effect_rows();
  const bool is_there = std::any_of(all.begin(), all.end(), [&](const Effect& other) {
    return other.name == row.name && other.site == row.site;
  });
  if (is_there)
    throw usage_error(fmt::format("effect '{}' of the {} exists", row.name, to_string(row.site)),
                      "give yours another name");
  if (all.size() == all.capacity())
    throw usage_error(fmt::format("more than {} effects of your own", kMostOwn), "drop some");
  all.push_back(row);
}

namespace {

const Effect& find_among(std::span<const Effect> rows, std::string_view name, Site site) {
  std::vector<std::string_view> known, elsewhere;
  for (const Effect& row : rows) {
    if (row.name == name && row.site == site) return row;
    if (row.name == name) elsewhere.push_back(to_string(row.site));
    if (row.site == site) known.push_back(row.name);
  }
  throw input_error({}, fmt::format("unknown effect '{}' of the {}", name, to_string(site)),
                    elsewhere.empty()
                        ? suggestion(name, known)
                        : fmt::format("there is one of: {}", fmt::join(elsewhere, ", ")));
}

}  // namespace

const Effect& find_base_effect(std::string_view name, Side side) {
  return find_among(base_effects(side), name, site_of(side));
}

const Effect& find_candidate(std::string_view name, Site site) {
  return find_among(candidate_effects(), name, site);
}

void fill_base_column(const Effect& row, const Motion& motion, Eigen::Ref<Eigen::VectorXd> column) {
  if (row.follows == MotionPart::constant)
    column.setOnes();
  else
    column = part_of(motion, row.follows).matrix();
}

Eigen::VectorXd base_torque(const std::vector<EffectInstance>& effects, const Motion& motion) {
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(motion.position.size());
  Eigen::VectorXd column(torque.size());
  for (const EffectInstance& instance : effects) {
    fill_base_column(*instance.effect, motion, column);
    torque += instance.parameters.front().value * column;
  }
  return torque;
}

double inertia_of(const std::vector<EffectInstance>& effects) {
  double sum = 0;
  for (const EffectInstance& instance : effects)
    if (instance.effect->is_inertia()) sum += instance.parameters.front().value;
  return sum;
}

}  // namespace cablefit
