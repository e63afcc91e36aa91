// The model behind the shipped logs of the low preload, as a model file.
#pragma once

namespace cablefit::test {

/// Table 1 and Table 2 of the paper, low preload: the parameters of the shipped low logs.
inline constexpr const char* kLowModel = R"({
  "schema": "cablefit/model/1", "preload": "low",
  "joints": [{"link": {"inertia": {"J_link": 0.339}, "viscous": {"f_v": 5.601},
                       "coulomb": {"f_s": 3.274}},
              "motor": {"inertia": {"J_motor": 0.0133}, "viscous": {"f_vm": 1.0654},
                        "coulomb": {"f_sm": 2.778}, "offset": {"offset": 0.0286}}}],
  "transmission": {"cables": [{"name": "1", "coefficients": [1367.7, 37844.1]},
                              {"name": "2", "coefficients": [1575.3, 29357.2]}]}})";

}  // namespace cablefit::test
