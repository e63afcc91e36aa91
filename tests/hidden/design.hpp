// Which runs an experiment consists of, and what one case of hidden data is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "effects/effects.hpp"
#include "floor.hpp"

namespace hidden {

struct Wish {
  const Row* row = nullptr;
  double m = 1;  ///< size in units of the row's
};

/// A further run of an advised experiment: a reference of its own, or the fast one at this load.
struct Extra {
  double load = 0;      ///< N m
  Reference reference;  ///< rad at 1 kHz; empty: fast and dithered
  bool blocked = false;
};

struct CaseSpec {
  std::string design = "full";
  std::uint64_t seed = 1;
  std::vector<Wish> effects;
  double clutter = 0;         ///< N m, sd of a low-frequency disturbance on the link
  bool controller = true;     ///< written down, with its reference
  bool poor_sensors = false;  ///< 14 bit encoders, 1 N m of torque noise
  double slow_noise = 0;      ///< N m, sd of what the torque signal has with 0.2 s
  std::optional<double> rho;  ///< each effect is scaled until this is its rho by itself
  std::optional<Extra> extra;
};

/// A design by name. full: slow and fast + dither at loads of +30, -40 and 0 N m, a blocked sweep,
/// two fresh validation runs. one_load: the same at one load. preloads: both preloads of the
/// paper's rig, one pair of cables. short: full with runs of 6 s, for CI.
struct Design {
  std::string_view name, meaning;
  std::vector<Run> (*runs)(std::uint64_t seed, const Bench& bench);
};
const std::vector<Design>& designs();
const Design& design_of(std::string_view name);

struct CaseEffect {
  const Row* row = nullptr;
  double m = 1;
  std::vector<Coefficient> coefficients;
  Rho rho;  ///< of this effect alone
};

struct Case {
  CaseSpec spec;
  Bench bench;  ///< without effects
  std::vector<CaseEffect> effects;
  std::vector<Run> runs;
  std::vector<Recording> recordings;  ///< in the order of `runs`
  PerEquation floor;                  ///< N m rms; see floor.hpp
  Rho rho;                            ///< of all effects and the clutter
  Rho background;                     ///< of the clutter alone
};

Case make_case(const CaseSpec& spec);

}  // namespace hidden
