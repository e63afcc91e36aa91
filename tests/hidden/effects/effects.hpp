// The effects that can be hidden in a data set. Names, sides and alias classes are those of the
// catalogue (docs/reference/effects.md); the equations are written here anew, from the literature
// and not from the library.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../simulate.hpp"

namespace hidden {

/// What a case drew for an effect; the same in all runs of the case.
struct Draw {
  double size = 0;          ///< the leading coefficient: size of the row times m
  double u = 0.5, w = 0.5;  ///< uniform in 0..1, for phases, orders, speeds, time constants
  int event_run = 1;        ///< number of the run in which an event happens
  double event_time = 10;   ///< s
  double peak_tau = 50;     ///< N m, largest command of the case without the effect
  std::uint64_t seed = 1;
};

struct Planted {
  Hooks hooks;
  std::vector<Coefficient> coefficients;
};

/// matched: the catalogue's form. other: the same physics in another functional form.
/// outside: nothing of the catalogue.
enum class Form { matched, other, outside };

/// Where the base model's residual shows it. `opposite`: in both rows with opposite sign.
enum class Shows { link, motor, opposite, both, nothing };

struct Row {
  std::string_view name, side, alias_class;
  Form form;
  std::string_view variant;  ///< "" for matched forms
  double size;               ///< leading coefficient at m = 1
  std::string_view unit;
  Shows shows;
  std::string_view acts;  ///< the equation
  Planted (*make)(const Draw&, const Run&, const Bench&);
  bool in_base = false;  ///< the base model has it: nothing to find
};

std::span<const Row> friction_rows();
std::span<const Row> drive_rows();
std::span<const Row> transmission_rows();
std::span<const Row> sensor_rows();
std::span<const Row> event_rows();
std::span<const Row> outside_rows();      ///< torques and modes
std::span<const Row> outside_law_rows();  ///< laws of friction and stiffness

/// All of them, in this order.
const std::vector<Row>& all_rows();

/// name.side or name.side.variant, as on the command line.
std::string id_of(const Row& row);

/// The row with this id; throws std::invalid_argument that lists all of them.
const Row& row_of(std::string_view id);

std::string_view to_string(Form form);

/// 0 before t = 0, then 1 - exp(-t/T): how things drift.
double saturating(double t, double T);

/// Of a path with a value per ms from t = -1 s on, straight between them.
double value_at(const std::vector<double>& path, double t);

/// +1, 0, -1.
inline double sign(double x) { return static_cast<double>((x > 0) - (x < 0)); }

}  // namespace hidden
