// Every number of a model that a fit can move, by name: effects of every axis and those added
// to them, stiffness or cable coefficients, initial elongations and encoder zeros.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// `arm`: a base parameter of a coupled arm; `added`: of an effect beyond (31).
enum class ParameterKind { arm, effect, added, stiffness, coefficient, elongation, encoder_zero };

/// Where a parameter stands in a model. Which members count depends on `kind`.
struct ModelParameter {
  ParameterKind kind = ParameterKind::effect;
  std::string name, symbol, unit;
  double lower = -kUnbounded, upper = kUnbounded;
  int joint = 0;         ///< effect, added, stiffness, encoder_zero
  bool on_link = false;  ///< effect: of the link side
  std::size_t effect = 0, cable = 0, index = 0;
};

/// Base parameters of the arm, effects joint by joint (link, motor, added), K or the coefficients
/// of every cable, l_o of every cable, theta_0 of every joint. A rigid drive has effects only.
std::vector<ModelParameter> model_parameters(const Model& model);

/// Of an effect that adds to an axis' inertia.
bool is_inertia(const Model& model, const ModelParameter& parameter);

/// Which of the shapes of an added effect it is; nothing: no shape.
std::optional<std::size_t> shape_of(const Model& model, const ModelParameter& parameter);

double parameter_value(const Model& model, const ModelParameter& parameter);
void set_parameter_value(Model& model, const ModelParameter& parameter, double value);

}  // namespace cablefit
