#include "cablefit/refine/radius_fit.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/refine/kept_joint.hpp"

namespace cablefit {
namespace {

std::size_t place(int joint) { return static_cast<std::size_t>(joint); }

const DisplacementMap& map_of(const Cable& cable, const Pulley& pulley, std::size_t joint) {
  return (pulley.side == Side::link ? cable.link_map : cable.motor_map)[joint];
}

/// With this sign a larger radius times the travel of the joint stretches the cable.
double sign_of(const Pulley& pulley) { return pulley.side == Side::link ? -1 : 1; }

/// The number of the cable among those of one joint, which have its name; nothing: it does not pass
/// the joint, or the joint holds it, so that no column changes.
std::optional<std::size_t> place_in(const Model& one, const Pulley& pulley) {
  const std::string& name = one.whole->transmission.cables[pulley.cable].name;
  const std::vector<Cable>& cables = one.transmission.cables;
  const auto found =
      std::find_if(cables.begin(), cables.end(), [&](const Cable& c) { return c.name == name; });
  if (found == cables.end() || is_held(one, *found)) return {};
  return static_cast<std::size_t>(found - cables.begin());
}

/// Cables need no more of a motion.
SmoothMotion positions_of(const SmoothMotion& motion) {
  SmoothMotion positions;
  positions.period = motion.period;
  positions.q = motion.q;
  positions.theta = motion.theta;
  positions.others = motion.others;
  return positions;
}

double reference_of(const Model& whole, const Pulley& pulley) {
  return pulley.side == Side::link ? whole.transmission.reference_q()(pulley.joint)
                                   : whole.transmission.reference_theta()(pulley.joint);
}

}  // namespace

std::vector<Pulley> pulleys_of(const Model& model) {
  std::vector<Pulley> all;
  if (!model.rig.cables_given) return all;
  const std::vector<Cable>& cables = model.transmission.cables;
  for (std::size_t cable = 0; cable < cables.size(); ++cable) {
    if (cables[cable].has_pairs()) continue;
    for (int joint = 0; joint < static_cast<int>(model.joints.size()); ++joint) {
      if (model.rig.axes.of(joint) != Axes::rotary) continue;
      for (const Side side : {Side::link, Side::motor}) {
        const Pulley pulley{cable, joint, side};
        const DisplacementMap& map = map_of(cables[cable], pulley, place(joint));
        if (map.kind->constant_radius && (side == Side::link || !map.is_zero()))
          all.push_back(pulley);
      }
    }
  }
  return all;
}

double radius_of(const Transmission& transmission, const Pulley& pulley) {
  return map_of(transmission.cables[pulley.cable], pulley, place(pulley.joint)).radius(0);
}

void set_radius(Transmission& transmission, const Pulley& pulley, double radius) {
  const auto set = pulley.side == Side::link ? set_link_radius : set_motor_radius;
  set(transmission, pulley.cable, place(pulley.joint), radius);
}

std::vector<Model> with_radius(std::vector<Model> models, const Pulley& pulley, double radius) {
  for (Model& model : models)
    for (Transmission* transmission : {&model.transmission, &model.rig.transmission})
      set_radius(*transmission, pulley, radius);
  return models;
}

RadiusFit::RadiusFit(const std::vector<Model>& models, const RefineLogs& logs)
    : models_(models), joints_(base_fits_of(models, logs)) {
  for (std::optional<BaseFit>& base : joints_)
    for (std::size_t k = 0; base && k < base->design.rows.size(); ++k) {
      StretchRows& rows = base->design.rows[k];
      rows.motion = std::make_shared<const SmoothMotion>(positions_of(*rows.motion));
    }
}

Eigen::ArrayXd RadiusFit::travel(const Pulley& pulley, std::size_t stretch) const {
  const std::optional<BaseFit>& own = joints_[place(pulley.joint)];
  if (!own || stretch >= own->design.rows.size()) return {};
  const SmoothMotion& motion = *own->design.rows[stretch].motion;
  const double reference = reference_of(model(), pulley);
  if (pulley.side == Side::link) return motion.q - reference;
  return motion.theta - model().transmission.encoder_zero()(pulley.joint) - reference;
}

BlockGrams RadiusFit::grams(const BaseFit& base, const Pulley& pulley, double change) const {
  const Design& design = base.design;
  const std::size_t cable = *place_in(design.models.front(), pulley);
  const bool is_own = design.models.front().joint == pulley.joint;
  std::vector<Model> models = design.models;
  for (Model& model : models) {
    if (!is_own) break;
    Cable& own = model.transmission.cables[cable];
    DisplacementMap& map = pulley.side == Side::link ? own.link_map[0] : own.motor_map[0];
    map = round_pulley(map.radius(0) + change);
    own.reference_displacement += sign_of(pulley) * change * reference_of(*model.whole, pulley);
  }
  std::vector<std::vector<ReplacedColumns>> columns;
  for (std::size_t k = 0; k < design.rows.size(); ++k) {
    const StretchRows& rows = design.rows[k];
    SmoothMotion motion = *rows.motion;
    if (!is_own)
      motion.others.col(static_cast<Eigen::Index>(cable)) +=
          sign_of(pulley) * change * travel(pulley, k);
    columns.push_back(columns_of_cables(motion, rows.kinds, design.layout,
                                        models[design.stretches[k].model], design.layout,
                                        design.smoothing, Evaluation::fine));
  }
  return replaced(base.grams, design.rows, design.stretches, columns, ScanSettings{}.block_seconds);
}

std::optional<RadiusFit::Errors> RadiusFit::errors(const Pulley& pulley, double change,
                                                   bool with_held_out) const {
  Errors all;
  const auto append = [](const Eigen::ArrayXd& more, Eigen::ArrayXd& to) {
    to.conservativeResize(to.size() + more.size());
    to.tail(more.size()) = more;
  };
  for (const std::optional<BaseFit>& base : joints_) {
    if (!base || !place_in(base->design.models.front(), pulley)) continue;
    const bool is_own = base->design.models.front().joint == pulley.joint;
    for (std::size_t k = 0; !is_own && k < base->design.rows.size(); ++k)
      if (travel(pulley, k).size() != base->design.rows[k].motion->size()) return {};
    const auto fit = fit_blocks(grams(*base, pulley, change), base->levels, with_held_out);
    if (!fit) return {};
    append(fit->in_sample, all.in_sample);
    if (with_held_out) append(fit->held_out, all.held_out);
  }
  if (all.in_sample.size() == 0) return {};
  return all;
}

}  // namespace cablefit
