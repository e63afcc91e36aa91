#include <algorithm>
#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

// Cables that are not just taut in the reference pose, as the model has them.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kHalfWidth[] = {
    {"half_width", "b", "rad", "of the motor, by which each cable is slack", 0}};
constexpr ParameterInfo kElongation[] = {
    {"l_o", "l_o", "rad", "of the motor, by which cable 1 is stretched at rest", 0}};
constexpr ShapeGrid kSlack[] = {
    {.low = 0.0016, .high = 0.16, .n_values = 10, .unit = GridUnit::deflection}};
constexpr ShapeGrid kStretch[] = {
    {.low = 0.0033, .high = 0.5, .n_values = 11, .unit = GridUnit::deflection}};

/// Signed radius at the motor pulley that moves the cable most, in the reference pose; 1 in joint
/// space.
double motor_radius(const Transmission& transmission, const Cable& cable) {
  const Eigen::VectorXd radii = cable.motor_radii(transmission.reference_theta());
  Eigen::Index most = 0;
  radii.cwiseAbs().maxCoeff(&most);
  return radii[most];
}

bool is_just_taut(const Cable& cable) { return cable.initial_elongation == 0; }

/// With cables, all of them just taut: a linear model gets a pair per joint.
std::optional<Transmission> with_taut_cables(const Transmission& transmission) {
  if (transmission.cables.empty()) return linear_pairs(transmission);
  if (!std::all_of(transmission.cables.begin(), transmission.cables.end(), is_just_taut))
    return std::nullopt;
  return transmission;
}

std::optional<Transmission> slacken(const Transmission& transmission, const double* shape) {
  std::optional<Transmission> changed = with_taut_cables(transmission);
  if (!changed) return std::nullopt;
  for (Cable& cable : changed->cables)
    cable.initial_elongation = -shape[0] * std::abs(motor_radius(*changed, cable));
  return changed;
}

/// The elongation at which the cable pulls with `force`; nothing when it never does.
std::optional<double> elongation_for(const Cable& cable, double force, double first_guess) {
  double high = first_guess;
  for (int doubled = 0; cable.force(high) < force; ++doubled, high *= 2)
    if (doubled == 20) return std::nullopt;
  double low = 0;
  while (high - low > 1e-15 * high) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (cable.force(middle) < force ? low : high) = middle;
  }
  return high;
}

/// Cables of one joint, in the order of the model.
std::vector<Cable*> cables_of(Transmission& transmission, int joint) {
  std::vector<Cable*> found;
  for (Cable& cable : transmission.cables)
    if (cable.motor_side().passes(static_cast<std::size_t>(joint))) found.push_back(&cable);
  return found;
}

/// Stretches the first of two opposed cables by `angle` of the motor and the other so that they
/// balance, (8c).
bool stretch_pair(const Transmission& transmission, const std::vector<Cable*>& pair, double angle) {
  if (pair.size() != 2) return false;
  const double radius = motor_radius(transmission, *pair[0]);
  const double other = motor_radius(transmission, *pair[1]);
  if (!(radius * other < 0)) return false;
  const double l = angle * std::abs(radius);
  const double wanted = pair[0]->force(l) * std::abs(radius / other);
  const std::optional<double> balancing = elongation_for(*pair[1], wanted, l);
  pair[0]->initial_elongation = l;
  pair[1]->initial_elongation = balancing.value_or(0);
  return balancing.has_value();
}

/// The law of the other cable is unknown, so nothing is balanced.
bool has_idle_partner(const Transmission& transmission) {
  return transmission.cables.size() == 1 && transmission.idle_cables.size() == 1;
}

std::optional<Transmission> stretch(const Transmission& transmission, const double* shape) {
  std::optional<Transmission> changed = with_taut_cables(transmission);
  if (changed && has_idle_partner(*changed)) {
    Cable& cable = changed->cables.front();
    cable.initial_elongation = shape[0] * std::abs(motor_radius(*changed, cable));
    return changed;
  }
  if (!changed || changed->cables.size() != 2 * static_cast<std::size_t>(changed->n_joints))
    return std::nullopt;
  for (int joint = 0; joint < changed->n_joints; ++joint)
    if (!stretch_pair(*changed, cables_of(*changed, joint), shape[0])) return std::nullopt;
  return changed;
}

/// Other coefficients balance at another elongation of the second cable.
std::optional<Transmission> stretch_again(const Transmission& transmission, const double* shape) {
  Transmission loose = transmission;
  for (Cable& cable : loose.cables) cable.initial_elongation = 0;
  return stretch(loose, shape);
}

}  // namespace

Effect dead_zone() {
  return {.name = "dead_zone",
          .site = Site::transmission,
          .alias_class = "l_o",
          .equation = "tau_elas = 0 for |phi| < b: l_o = -b r in every cable",
          .signature =
              "a flat spot where the torque changes sign; preload is stiff there "
              "instead, a higher order shows at the peak load",
          .experiment = "blocked link, a slow ramp through zero torque",
          .source = "Fichera & Grossard 2017, (4)",
          .parameters = kHalfWidth,
          .shape = kSlack,
          .is_static = true,
          .change = slacken};
}

Effect preload() {
  return {.name = "preload",
          .site = Site::transmission,
          .alias_class = "l_o",
          .equation =
              "l_o of cable 1; that of the other cable follows from S f = 0 in the reference pose",
          .signature =
              "both cables are taut near zero torque, with twice the slope and a kink where "
              "one goes slack; a dead zone is flat there instead",
          .experiment = "blocked link, a slow ramp through zero torque until a cable goes slack",
          .source = "Fichera & Grossard 2017, (8c), (19e)",
          .parameters = kElongation,
          .shape = kStretch,
          .is_static = true,
          .change = stretch,
          .change_again = stretch_again};
}

}  // namespace cablefit::rows
