#include "write.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace hidden {
namespace {

using nlohmann::ordered_json;

/// Nine significant decimals after the point at most: 1 nrad, 1 nN m.
void append(std::string& to, double x) {
  char buffer[40];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::fixed, 9).ptr;
  std::string_view text(buffer, static_cast<std::size_t>(end - buffer));
  text.remove_suffix(text.size() - 1 - text.find_last_not_of('0'));
  if (text.ends_with('.')) text.remove_suffix(1);
  to += text == "-0" ? "0" : text;
}

ordered_json rig_json(const Case& one, const Run& run) {
  const Bench& b = one.bench;
  ordered_json rig{{"schema", "cablefit/rig/1"},
                   {"name", "hidden-effect rig"},
                   {"torque_hold", "zoh"},
                   {"load", {{"type", "column"}}},
                   {"sensors",
                    {{"q", {{"quantum", b.quantum_q}}},
                     {"theta", {{"quantum", b.quantum_theta}}},
                     {"tau", {{"noise", std::hypot(b.noise_tau, b.slow_noise_tau)}}}}}};
  if (one.spec.controller)
    rig["controller"] = {
        {"type", "pd"}, {"kp", b.kp}, {"kd", b.kd}, {"limit", b.limit}, {"reference", "theta_ref"}};
  if (run.preload.empty()) return rig;
  rig["preload"] = run.preload;
  // In cable space, because only there the rig file can say what l_o is. Pulleys of 1 m keep the
  // numbers of joint space.
  const Rig known = run.l_o != 0 ? preloaded(b.rig, run.l_o) : b.rig;
  for (const auto& [name, radius, l_o] :
       {std::tuple{"1", 1.0, known.cable_1.l_o}, std::tuple{"2", -1.0, known.cable_2.l_o}})
    rig["cables"].push_back({{"name", name},
                             {"motor_radius", radius},
                             {"link_radius", radius},
                             {"order", 2},
                             {"initial_elongation", l_o}});
  return rig;
}

ordered_json rho_json(const Rho& rho) {
  return {{"all", rho.all},
          {"link", rho.each[kLinkRows]},
          {"motor", rho.each[kMotorRows]},
          {"blocked", rho.each[kBlockedRows]}};
}

ordered_json effect_json(const CaseEffect& effect) {
  const Row& row = *effect.row;
  ordered_json out{{"id", id_of(row)},
                   {"name", row.name},
                   {"side", row.side},
                   {"alias_class", row.alias_class},
                   {"form", to_string(row.form)},
                   {"variant", row.variant},
                   {"in_base", row.in_base},
                   {"acts", row.acts},
                   {"m", effect.m},
                   {"rho", rho_json(effect.rho)},
                   {"coefficients", ordered_json::array()}};
  for (const Coefficient& c : effect.coefficients)
    out["coefficients"].push_back({{"name", c.name}, {"value", c.value}, {"unit", c.unit}});
  return out;
}

ordered_json base_json(const Rig& r) {
  return {{"J_link", r.J_link},     {"J_motor", r.J_motor},   {"f_v", r.f_v},
          {"f_s", r.f_s},           {"f_vm", r.f_vm},         {"f_sm", r.f_sm},
          {"offset", r.offset},     {"K1_0", r.cable_1.c[0]}, {"K1_1", r.cable_1.c[1]},
          {"K2_0", r.cable_2.c[0]}, {"K2_1", r.cable_2.c[1]}};
}

/// What a tool that is never wrong says.
std::string expected(const Case& one) {
  bool outside = one.spec.clutter > 0, named = false;
  for (const CaseEffect& effect : one.effects) {
    if (effect.row->form == Form::outside)
      outside = true;
    else if (!effect.row->in_base)
      named = true;
  }
  return named ? "named" : outside ? "unexplained" : "none";
}

std::string file_of(const Run& run) {
  return (run.preload.empty() ? "" : run.preload + "/") + run.name + ".csv";
}

ordered_json truth_json(const Case& one) {
  ordered_json truth{{"schema", "hidden/truth/1"},
                     {"design", one.spec.design},
                     {"seed", one.spec.seed},
                     {"clutter", one.spec.clutter},
                     {"expected", expected(one)},
                     {"effects", ordered_json::array()},
                     {"rho", rho_json(one.rho)},
                     {"rho_background", rho_json(one.background)},
                     {"floor",
                      {{"unit", "N m"},
                       {"link", one.floor[kLinkRows]},
                       {"motor", one.floor[kMotorRows]},
                       {"blocked", one.floor[kBlockedRows]}}},
                     {"base", base_json(one.bench.rig)},
                     {"logs",
                      {{"train", ordered_json::array()},
                       {"test", ordered_json::array()},
                       {"blocked", ordered_json::array()}}}};
  for (const CaseEffect& effect : one.effects) truth["effects"].push_back(effect_json(effect));
  for (const Run& run : one.runs) truth["logs"][run.role].push_back(file_of(run));
  return truth;
}

}  // namespace

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

void write_log(const std::filesystem::path& file, const Signals& log, bool with_reference) {
  std::string text = log.blocked ? "t,q,theta,tau" : "t,q,theta,tau,tau_load";
  text += with_reference ? ",theta_ref\n" : "\n";
  text.reserve(log.q.size() * 64);
  for (std::size_t k = 0; k < log.q.size(); ++k) {
    append(text, static_cast<double>(k) / kRate);
    for (const double x : {log.q[k], log.theta[k], log.tau[k]}) append(text += ',', x);
    if (!log.blocked) append(text += ',', log.load);
    if (with_reference) append(text += ',', log.theta_ref[k]);
    text += '\n';
  }
  write_text(file, text);
}

void write_case(const std::filesystem::path& folder, const Case& one) {
  for (std::size_t i = 0; i < one.runs.size(); ++i) {
    const Run& run = one.runs[i];
    const std::filesystem::path file = folder / file_of(run);
    std::filesystem::create_directories(file.parent_path());
    write_log(file, one.recordings[i].logged, one.spec.controller);
    write_text(file.parent_path() / "rig.json", rig_json(one, run).dump(2) + '\n');
  }
  write_text(folder / "truth.json", truth_json(one).dump(2) + '\n');
}

}  // namespace hidden
