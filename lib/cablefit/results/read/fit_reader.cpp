#include "cablefit/results/read/fit_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/model.hpp"
#include "cablefit/results/read/proof_reader.hpp"
#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit::result_file {
namespace {

constexpr std::string_view kLinear = "linear";

double value_of(const ElasticFit& fit, const std::string& name, const MissingCoefficient& missing) {
  if (const Estimate* e = find_estimate(fit.parameters, name)) return e->value;
  throw missing.place->error(fmt::format("parameter '{}' is missing", name),
                             std::string(missing.hint));
}

/// The cable as far as the file has coefficients for it; orders differ between cables.
void take_cable(const ElasticFit& fit, const MissingCoefficient& missing, bool cable_space,
                Cable& cable) {
  const auto name = [&](int k) { return coefficient_name(cable, k, cable_space); };
  int count = 0;
  while (find_estimate(fit.parameters, name(count)) != nullptr) ++count;
  cable.order = 1;
  while (cable.order < cable.law->max_order && cable.n_coefficients() < count) ++cable.order;
  cable.coefficients.clear();
  for (int k = 0; k < cable.n_coefficients(); ++k)
    cable.coefficients.push_back(value_of(fit, name(k), missing));
  if (const Estimate* l_o = find_estimate(fit.parameters, elongation_name(cable))) {
    cable.initial_elongation = l_o->value;
  }
}

void take_transmission(const Rig& rig, const MissingCoefficient& missing, ElasticFit& fit) {
  fit.transmission = rig.transmission;
  const int n = rig.n_joints();
  if (fit.model == kLinear ||
      find_estimate(fit.parameters, joint_parameter_name("K", 1, n)) != nullptr) {
    fit.transmission = classical_spring(rig.transmission);
    for (int joint = 0; joint < n; ++joint)
      fit.transmission.linear_stiffness(joint) =
          value_of(fit, joint_parameter_name("K", joint + 1, n), missing);
    return;
  }
  for (Cable& cable : fit.transmission.cables) take_cable(fit, missing, rig.cables_given, cable);
}

/// Without the curve: a cable that stage 1 never pulled has no coefficients and counts as slack,
/// and a note says so. Coefficients that are only not separable are not 0.
void require_curve(const MissingCoefficient& missing, bool cable_space, ElasticFit& fit) {
  for (Cable& cable : fit.transmission.cables)
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      double& coefficient = cable.coefficients[static_cast<std::size_t>(k)];
      if (!std::isnan(coefficient)) continue;
      const Estimate* e = find_estimate(fit.parameters, coefficient_name(cable, k, cable_space));
      if (e->not_identifiable.find("separable") != std::string::npos)
        throw missing.place->error(
            fmt::format("{} is not identifiable, and 'curve_coefficients' is missing", e->name),
            std::string(missing.hint));
      coefficient = 0;
    }
}

/// The curve that was fitted, where some of its coefficients have no value of their own: only the
/// torque of all together is determined.
void take_curve(const JsonNode& node, const MissingCoefficient& missing, bool cable_space,
                ElasticFit& fit) {
  const JsonNode* given = node.find("curve_coefficients");
  std::vector<Cable>& cables = fit.transmission.cables;
  if (given == nullptr) {
    require_curve(missing, cable_space, fit);
    return;
  }
  if (!given->is_array() || given->items.size() != cables.size())
    throw given->error(
        fmt::format("expected a list of coefficients for each of {} cables", cables.size()),
        "run `cablefit elastic` again");
  for (std::size_t k = 0; k < cables.size(); ++k) {
    const std::vector<double> own = given->items[k].numbers();
    if (own.size() != cables[k].coefficients.size())
      throw given->items[k].error(
          fmt::format("{} coefficients, expected {}", own.size(), cables[k].coefficients.size()),
          "run `cablefit elastic` again");
    cables[k].coefficients = own;
  }
}

void take_theta_0(const JsonNode& node, ElasticFit& fit) {
  const int n = fit.transmission.n_joints;
  fit.transmission.theta_0 = fit.transmission.encoder_zero();
  const JsonNode* zero = node.find("theta_0");
  if (zero == nullptr || zero->is_null()) return;
  const std::vector<double> values =
      zero->is_array() ? zero->numbers() : std::vector<double>{zero->number()};
  if (values.size() != static_cast<std::size_t>(n)) {
    throw zero->error(fmt::format("{} value(s), expected {}", values.size(), n),
                      "give one per joint");
  }
  fit.transmission.theta_0 = Eigen::Map<const Eigen::VectorXd>(values.data(), n);
}

Eigen::Index n_coefficients(const Transmission& transmission) {
  if (transmission.cables.empty()) return transmission.linear_stiffness.size();
  Eigen::Index n = 0;
  for (const Cable& cable : transmission.cables) n += cable.n_coefficients();
  return n;
}

Eigen::MatrixXd read_covariance(const JsonNode& node, Eigen::Index n) {
  Eigen::MatrixXd covariance(n, n);
  const auto fail = [&] {
    return node.error(fmt::format("not a {} x {} matrix", n, n),
                      "one row and column per coefficient; run `cablefit elastic` again");
  };
  if (!node.is_array() || static_cast<Eigen::Index>(node.items.size()) != n) throw fail();
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double> row = node.items[static_cast<std::size_t>(i)].numbers();
    if (static_cast<Eigen::Index>(row.size()) != n) throw fail();
    covariance.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), n);
  }
  return covariance;
}

std::vector<ElasticJointErrors> read_joint_errors(const JsonNode& node) {
  std::vector<ElasticJointErrors> joints;
  for (const JsonNode& item : items_or_none(node, "joints"))
    joints.push_back({number_or_nan(item, "rms_error"), number_or_nan(item, "max_abs_error"),
                      number_or_nan(item, "held_out_rms"), number_or_nan(item, "held_out_max")});
  return joints;
}

ElasticMisfit read_misfit(const JsonNode& node) {
  ElasticMisfit misfit;
  for (const JsonNode& item : items_or_none(node, "misfit"))
    misfit.points.push_back({item.at("deflection").number(), item.at("torque").number(),
                             item.at("half_width").number()});
  return misfit;
}

}  // namespace

int read_order(const JsonNode& node) {
  const JsonNode* order = node.find("order");
  if (order == nullptr) return 1;
  const double value = order->positive();
  if (value == static_cast<int>(std::min(value, 1.0 * kMaxCableOrder))) {
    return static_cast<int>(value);
  }
  throw order->error(fmt::format("{} is not an order", value),
                     fmt::format("write a whole number of 1 to {}", kMaxCableOrder));
}

void read_curve(const JsonNode& node, const Rig& rig, const MissingCoefficient& missing,
                ElasticFit& fit) {
  take_transmission(rig, missing, fit);
  take_curve(node, missing, rig.cables_given, fit);
  take_theta_0(node, fit);
  const JsonNode* offset = node.find("offset");
  if (offset != nullptr && !offset->is_array()) fit.offset = offset->number();
}

ElasticFit read_elastic_fit(const JsonNode& node, const Rig* rig) {
  ElasticFit fit;
  fit.model = node.at("model").text();
  fit.order = read_order(node);
  const JsonNode& list = node.at("parameters");
  fit.parameters = read_estimates(list);
  if (rig != nullptr) {
    read_curve(node, *rig,
               {&list, "the rig of this preload needs it; run `cablefit elastic` again"}, fit);
    fit.covariance = read_covariance(node.at("covariance"), n_coefficients(fit.transmission));
  }
  fit.passive = flag_or(node, "passive", true);
  fit.active_bounds = texts_or_none(node, "active_bounds");
  fit.warnings = texts_or_none(node, "warnings");
  if (const JsonNode* derived = node.find("derived")) fit.derived = read_estimates(*derived);
  fit.joints = read_joint_errors(node);
  fit.misfit = read_misfit(node);
  fit.proof = read_proof(node);
  fit.rms_error = number_or_nan(node, "rms_error");
  fit.max_abs_error = number_or_nan(node, "max_abs_error");
  fit.held_out_rms = number_or_nan(node, "held_out_rms");
  fit.held_out_max = number_or_nan(node, "held_out_max");
  fit.condition = number_or_nan(node, "condition");
  fit.effective_rows = number_or_nan(node, "effective_rows");
  return fit;
}

}  // namespace cablefit::result_file
