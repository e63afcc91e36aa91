// Makes one data set with a hidden effect, or lists what can be hidden. See --help.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <numbers>

#include "real.hpp"
#include "user_log.hpp"
#include "varied_rig.hpp"
#include "write.hpp"

namespace {

using namespace hidden;

/// One JSON document with every table, for the runner.
void list() {
  nlohmann::ordered_json out;
  for (const Row& row : all_rows())
    out["effects"].push_back({{"id", id_of(row)},
                              {"name", row.name},
                              {"side", row.side},
                              {"alias_class", row.alias_class},
                              {"form", to_string(row.form)},
                              {"size", row.size},
                              {"unit", row.unit},
                              {"in_base", row.in_base},
                              {"acts", row.acts}});
  for (const Design& one : designs())
    out["designs"].push_back({{"name", one.name}, {"meaning", one.meaning}});
  for (const RealSet& set : real_sets())
    for (const RealEffect& effect : real_effects())
      if (set.blocked ? effect.blocked : effect.moving)
        out["real"].push_back({{"set", set.name}, {"effect", effect.name}});
  fmt::print("{}\n", out.dump(2));
}

Wish wish_of(const std::string& text) {
  const auto equals = text.find('=');
  Wish wish{&row_of(text.substr(0, equals)), 1};
  if (equals != std::string::npos) wish.m = std::stod(text.substr(equals + 1));
  return wish;
}

/// Column theta_ref at 1 kHz, read off between the rows of the file, the load of its first row if
/// it has one, and whether its comment wants the link blocked.
Extra extra_of(const std::string& file, double load) {
  const RealLog log = read_log(file);
  const Eigen::VectorXd t = log.column("t"), reference = log.column("theta_ref");
  Extra extra{load, {}, log.comment == "# with the link blocked"};
  Eigen::Index row = 0;
  for (double now = t[0]; row + 1 < t.size(); now += 1 / kRate) {
    while (row + 1 < t.size() && t[row + 1] <= now) ++row;
    if (row + 1 == t.size()) break;
    const double share = (now - t[row]) / (t[row + 1] - t[row]);
    extra.reference.push_back((1 - share) * reference[row] + share * reference[row + 1]);
  }
  if (log.has("tau_load")) extra.load = log.column("tau_load")[0];
  return extra;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Data with a hidden effect, to test who finds it"};
  app.require_subcommand(1);
  app.add_subcommand("list", "every effect, design and real set, as JSON")->callback(list);

  CaseSpec spec;
  std::string out, extra_file;
  std::vector<std::string> effects;
  double rho = 0, extra_load = 0;
  auto& one = *app.add_subcommand("case", "simulate one case");
  one.add_option("--out", out, "folder")->required();
  one.add_option("--effect", effects, "ID or ID=M (M in units of the size in the table); repeat");
  one.add_option("--seed", spec.seed, "rig, references, phases, noise");
  one.add_option("--design", spec.design, "which runs");
  one.add_option("--clutter", spec.clutter, "sd of a wandering torque on the link, N m");
  bool no_controller = false;
  one.add_flag("--no-controller", no_controller, "the rig file has none, the logs no theta_ref");
  one.add_flag("--poor-sensors", spec.poor_sensors, "14 bit encoders, 1 N m of torque noise");
  one.add_option("--slow-noise", spec.slow_noise, "sd of torque noise with 0.2 s, N m");
  auto* with_rho =
      one.add_option("--rho", rho, "scale each effect until this is its rho by itself");
  auto* with_load = one.add_option("--extra-load", extra_load, "a further run at this load, N m");
  auto* with_file = one.add_option("--extra", extra_file,
                                   "a further run by columns t, theta_ref (and tau_load) of a CSV");
  one.callback([&] {
    for (const std::string& text : effects) spec.effects.push_back(wish_of(text));
    spec.controller = !no_controller;
    if (with_rho->count() > 0) spec.rho = rho;
    if (with_load->count() + with_file->count() > 0)
      spec.extra =
          extra_file.empty() ? Extra{extra_load, {}, false} : extra_of(extra_file, extra_load);
    write_case(out, make_case(spec));
  });

  RealSpec real;
  std::string data;
  auto& plant = *app.add_subcommand("plant", "add a known torque to the tau of real logs");
  plant.add_option("--out", out, "folder")->required();
  plant.add_option("--data", data, "folder of the shared data")->required();
  plant.add_option("--set", real.set, "emps, sea or xl330")->required();
  plant.add_option("--effect", real.effect, "name")->required();
  plant.add_option("--ratio", real.ratio, "rms of the torque over what the base model leaves");
  plant.add_option("--seed", real.seed, "phases");
  plant.callback([&] { plant_real(data, real, out); });

  UserSpec user;
  int bits = 0;
  auto& free = *app.add_subcommand("user", "an effect-free rig, logged as a user's bench would");
  free.add_option("--out", out, "folder")->required();
  free.add_option("--preload", user.preload, "low or high");
  free.add_option("--seed", user.seed, "rig, motion, noise");
  free.add_option("--seconds", user.seconds, "of the moving log");
  free.add_option("--rate", user.rate, "Hz, of the moving log");
  free.add_option("--torque-mean", user.torque_mean, "s");
  free.add_option("--white", user.white, "N m");
  free.add_option("--coloured", user.coloured, "N m");
  free.add_option("--bits", bits, "of both encoders; 0: their own steps; -1: no steps");
  free.add_option("--l-o", user.l_o, "rad, hidden, of the low preload");
  free.add_option("--lost", user.lost, "share of the moving log's rows");
  free.add_option("--stamp-jitter", user.stamp_jitter, "s");
  free.add_option("--sample-jitter", user.sample_jitter, "s");
  free.add_flag("--controller", user.controller, "write the controller and its reference");
  free.callback([&] {
    if (bits != 0)
      user.quantum_q = user.quantum_theta = bits > 0 ? 2 * std::numbers::pi / std::exp2(bits) : 0;
    write_user_rig(out, user);
  });

  std::uint64_t varied_seed = 1;
  auto& varied = *app.add_subcommand("varied", "an effect-free rig of any size, logged in any way");
  varied.add_option("--out", out, "folder")->required();
  varied.add_option("--seed", varied_seed, "rig, motion, noise");
  varied.callback([&] { write_varied_rig(out, varied_seed); });

  CLI11_PARSE(app, argc, argv);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "hidden_data: {}\n", error.what());
  return 1;
}
