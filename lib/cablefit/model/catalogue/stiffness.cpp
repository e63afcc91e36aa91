#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

// Cables of another law.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kOrder[] = {
    {"order", "n", "", "orders more than the model's cables have", 1, 2}};
constexpr ShapeGrid kOrders[] = {
    {.low = 1, .high = 2, .n_values = 2, .is_geometric = false, .is_whole = true}};

bool can_rise(const Cable& cable, int orders) {
  return cable.order + orders <= cable.law->max_order;
}

std::optional<Transmission> raise_order(const Transmission& transmission, const double* shape) {
  // A spring's next order is that of two cables, each with its own.
  Transmission changed = transmission.cables.empty() ? linear_pairs(transmission) : transmission;
  const int orders = static_cast<int>(std::lround(shape[0]));
  for (Cable& cable : changed.cables) {
    if (!can_rise(cable, orders)) return std::nullopt;
    cable.order += orders;
    cable.coefficients.resize(static_cast<std::size_t>(cable.n_coefficients()));
  }
  return changed;
}

std::optional<Transmission> two_cables(const Transmission& transmission, const double* /*shape*/) {
  if (!transmission.cables.empty()) return std::nullopt;
  return linear_pairs(transmission);
}

}  // namespace

Transmission linear_pairs(const Transmission& transmission) {
  Transmission pairs = antagonist_pairs(transmission.n_joints, 1);
  pairs.theta_0 = transmission.theta_0;
  const Eigen::VectorXd reduction = transmission.reductions();
  for (std::size_t i = 0; i < pairs.cables.size(); ++i) {
    const std::size_t joint = i / 2;
    const auto k = static_cast<Eigen::Index>(joint);
    Cable& cable = pairs.cables[i];
    cable.coefficients = {transmission.linear_stiffness[k]};
    cable.link_map[joint] = round_pulley(reduction[k] * cable.link_map[joint].radius(0));
  }
  set_reference(pairs, transmission.reference);
  return pairs;
}

Effect stiffness_order() {
  return {.name = "stiffness_order",
          .site = Site::transmission,
          .equation = "f = sum_j K_j l^(j+1), `order` more terms than the model has",
          .signature =
              "smooth, largest at the peak load; a dead zone and preload show near zero "
              "deflection instead",
          .experiment = "blocked link, slow ramps up to the peak load on both cables",
          .source = "Fichera & Grossard 2017, (16)",
          .parameters = kOrder,
          .shape = kOrders,
          .is_static = true,
          .change = raise_order};
}

Effect stiffness_asymmetry() {
  return {.name = "stiffness_asymmetry",
          .site = Site::transmission,
          .equation = "K1 for phi > 0, K2 for phi < 0 instead of one K",
          .signature = "another slope for either sign of the load; poly models have it already",
          .experiment = "blocked link, loads of both signs",
          .source = "Fichera & Grossard 2017, Table 1",
          .is_static = true,
          .change = two_cables};
}

}  // namespace cablefit::rows
