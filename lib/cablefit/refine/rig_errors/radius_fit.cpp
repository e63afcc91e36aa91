#include "cablefit/refine/rig_errors/radius_fit.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/refine/bases/kept_joint.hpp"

namespace cablefit {
namespace {

constexpr double kSlopeStep = 1e-5;  // of the cable's largest radius

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

/// Of a pulley on the joint whose equation it is.
void change_own(Cable& cable, const RadiusChange& change, const Model& whole) {
  const Pulley& pulley = change.pulley;
  DisplacementMap& map = pulley.side == Side::link ? cable.link_map[0] : cable.motor_map[0];
  map = round_pulley(map.radius(0) + change.by);
  cable.reference_displacement += sign_of(pulley) * change.by * reference_of(whole, pulley);
}

RadiusChanges with_change(RadiusChanges changes, const RadiusChange& more) {
  changes.push_back(more);
  return changes;
}

VariantColumns zero_columns(const std::vector<StretchRows>& rows, Eigen::Index n) {
  VariantColumns all;
  for (const StretchRows& stretch : rows) {
    auto& kinds = all.emplace_back();
    for (const KindRows& kind : stretch.kinds)
      kinds.push_back(Eigen::MatrixXd::Zero(kind.base.rows(), n));
  }
  return all;
}

/// Column `i` of the torque: its difference between two radii over their distance `h`.
void set_slopes(const std::vector<std::vector<ReplacedColumns>>& at,
                const std::vector<std::vector<ReplacedColumns>>& larger, double h,
                const Eigen::VectorXd& x, Eigen::Index i, VariantColumns& torque) {
  for (std::size_t k = 0; k < torque.size(); ++k)
    for (std::size_t kind = 0; kind < torque[k].size(); ++kind) {
      const ReplacedColumns &a = at[k][kind], &b = larger[k][kind];
      torque[k][kind].col(i) =
          (b.columns - a.columns) * x.segment(a.first - 1, a.columns.cols()) / h;
    }
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

double largest_radius(const Cable& cable) {
  double largest = 0;
  for (const auto* maps : {&cable.motor_map, &cable.link_map})
    for (const DisplacementMap& map : *maps) largest = std::max(largest, std::abs(map.radius(0)));
  return largest;
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

bool RadiusFit::concerns(const RadiusChanges& changes, std::size_t joint) const {
  const std::optional<BaseFit>& base = joints_[joint];
  return base && std::any_of(changes.begin(), changes.end(), [&](const RadiusChange& change) {
           return place_in(base->design.models.front(), change.pulley).has_value();
         });
}

bool RadiusFit::knows(const Pulley& pulley) const {
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    if (joint == place(pulley.joint) || !concerns({{pulley, 0}}, joint)) continue;
    const std::vector<StretchRows>& rows = joints_[joint]->design.rows;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (travel(pulley, k).size() != rows[k].motion->size()) return false;
  }
  return true;
}

std::optional<RadiusFit::Columns> RadiusFit::columns(const BaseFit& base,
                                                     const RadiusChanges& changes) const {
  const Design& design = base.design;
  std::vector<Model> models = design.models;
  std::vector<RadiusChange> of_others;
  for (const RadiusChange& change : changes) {
    const auto cable = place_in(design.models.front(), change.pulley);
    if (!cable) continue;
    if (design.models.front().joint == change.pulley.joint)
      for (Model& model : models)
        change_own(model.transmission.cables[*cable], change, *model.whole);
    else
      of_others.push_back(change);
  }
  Columns all;
  for (std::size_t k = 0; k < design.rows.size(); ++k) {
    const StretchRows& rows = design.rows[k];
    SmoothMotion motion = *rows.motion;
    for (const RadiusChange& change : of_others) {
      const Eigen::ArrayXd turned = travel(change.pulley, k);
      if (turned.size() != motion.size()) return {};
      const auto cable = *place_in(design.models.front(), change.pulley);
      motion.others.col(static_cast<Eigen::Index>(cable)) +=
          sign_of(change.pulley) * change.by * turned;
    }
    all.push_back(columns_of_cables(motion, rows.kinds, design.layout,
                                    models[design.stretches[k].model], design.layout,
                                    design.smoothing, Evaluation::fine));
  }
  return all;
}

std::optional<RadiusFit::Errors> RadiusFit::errors(const RadiusChanges& changes,
                                                   bool with_held_out) const {
  Errors all;
  const auto append = [](const Eigen::ArrayXd& more, Eigen::ArrayXd& to) {
    to.conservativeResize(to.size() + more.size());
    to.tail(more.size()) = more;
  };
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    if (!concerns(changes, joint)) continue;
    const BaseFit& base = *joints_[joint];
    const auto other = columns(base, changes);
    if (!other) return {};
    const auto fit = fit_blocks(replaced(base.grams, base.design.rows, base.design.stretches,
                                         *other, ScanSettings{}.block_seconds),
                                base.levels, with_held_out);
    if (!fit) return {};
    all.joints.push_back(joint);
    append(fit->in_sample, all.in_sample);
    if (with_held_out) append(fit->held_out, all.held_out);
  }
  if (all.in_sample.size() == 0) return {};
  return all;
}

std::optional<CommonColumns> RadiusFit::slopes(const RadiusChanges& changes,
                                               const std::vector<Pulley>& of) const {
  const double block_seconds = ScanSettings{}.block_seconds;
  CommonColumns slopes(static_cast<Eigen::Index>(of.size()));
  RadiusChanges concerned = changes;
  for (const Pulley& pulley : of) concerned.push_back({pulley, 0});
  bool any = false;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    if (!concerns(concerned, joint)) continue;
    const BaseFit& base = *joints_[joint];
    const auto changed = columns(base, changes);
    if (!changed) return {};
    std::vector<StretchRows> rows = base.design.rows;
    for (std::size_t k = 0; k < rows.size(); ++k) put_in(rows[k], (*changed)[k]);
    const BlockGrams grams = block_grams(rows, base.design.stretches, block_seconds);
    const auto fit = fit_blocks(grams, base.levels, false);
    if (!fit) return {};
    VariantColumns torque = zero_columns(rows, static_cast<Eigen::Index>(of.size()));
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (!concerns({{of[i], 0}}, joint)) continue;
      const double h = kSlopeStep * largest_radius(model().transmission.cables[of[i].cable]);
      const auto larger = columns(base, with_change(changes, {of[i], h}));
      if (!larger) return {};
      set_slopes(*changed, *larger, h, fit->x, static_cast<Eigen::Index>(i), torque);
    }
    slopes.add_joint(extended(grams, rows, base.design.stretches, torque, block_seconds),
                     base.levels, fit->x);
    any = true;
  }
  if (!any) return {};
  return slopes;
}

}  // namespace cablefit
