#include <fmt/format.h>
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/model/rig.hpp"
#include <cstdlib>
int main(int argc, char** argv) {
  using namespace cablefit;
  try {
    std::vector<LogSurvey> logs;
    ElasticOptions o;
    for (int i = 1; i < argc; ++i) {
      std::string a = argv[i];
      if (a == "-c") { o.samples.cutoff = std::stod(argv[++i]); continue; }
      if (a == "-d") { o.samples.decimate = std::stoi(argv[++i]); continue; }
      if (a == "-e") { o.samples.drop_edge = std::stoi(argv[++i]); continue; }
      if (a == "-r") { o.samples.rest_speed = std::stod(argv[++i]); continue; }
      if (a == "-h") { o.samples.torque_hold = std::string(argv[++i]) == "zoh" ? TorqueHold::zoh : TorqueHold::none; continue; }
      if (a == "--still") { o.still = true; continue; }
      if (a.rfind("-o", 0) == 0) { o.order = std::stoi(a.substr(2)); continue; }
      Rig rig = rig_for_log(a, "");
      logs.push_back(survey_log(plan_log(a, rig), rig.preload));
    }
    if (getenv("DYN")) {
      DynamicOptions d; d.samples = o.samples;
      std::vector<LogSurvey> mv; for (auto& l : logs) mv.push_back(l);
      ElasticResult er; if (std::string(getenv("DYN")) != "rigid") { er = fit_elastic(logs, o); d.models = {"linear","poly"}; } else d.models = {"rigid"};
      auto r = fit_dynamic(mv, er, d);
      for (auto& p : r.preloads) {
        fmt::print("{} f0 {:.4g}\n", p.name, p.resonance);
        for (auto& x : p.decisions) fmt::print("   {} = {} ({})\n", x.name, x.value, x.reason);
        for (auto& [k, c] : p.counts) fmt::print("   {}: used {} rest {} edges {}\n", k, c.rows_used, c.rows_at_rest, c.rows_at_edges);
        for (auto& w : p.warnings) fmt::print("   warning: {}\n", w);
        for (auto& f : p.fits) {
          for (auto& [k, e] : f.torque_error) fmt::print("  {} {} rms {:.4g} max {:.4g} rel {:.4g}% cond {:.4g} neff {:.0f}\n", f.model, k, e.rms, e.max_abs, 100*e.relative, f.condition[k], f.effective_rows[k]);
          for (auto& e : f.parameters) fmt::print("    {:8} {:12.6g} sd {:.4g} ({:.2f}%) white {:.4g} {} {}\n", e.name, e.value, e.sd, e.rsd_percent(), e.sd_white, e.not_identifiable, e.active_bound);
          for (auto& w : f.warnings) fmt::print("    warning: {}\n", w);
        }
      }
      return 0;
    }
    auto r = fit_elastic(logs, o);
    for (auto& p : r.preloads) {
      fmt::print("{} range {:.4g}..{:.4g} peak {:.4g} used {} rest {} unused {} edges {} selected {}\n", p.name, p.deflection_low, p.deflection_high, p.peak_torque, p.counts.rows_used, p.counts.rows_at_rest, p.counts.rows_not_used, p.counts.rows_at_edges, p.selected);
      for (auto& d : p.decisions) fmt::print("   {} = {} ({})\n", d.name, d.value, d.reason);
      for (auto& s : p.selection) fmt::print("   {}\n", s);
      for (auto& w : p.warnings) fmt::print("   warning: {}\n", w);
      for (auto& f : p.fits) {
        fmt::print("  {} order {} rms {:.4g} max {:.4g} held rms {:.4g} max {:.4g} passive {} cond {:.3g} neff {:.0f}\n", f.model, f.order, f.rms_error, f.max_abs_error, f.held_out_rms, f.held_out_max, f.passive, f.condition, f.effective_rows);
        for (auto& e : f.parameters) fmt::print("    {:8} {:12.6g} sd {:.4g} white {:.4g} {} {}\n", e.name, e.value, e.sd, e.sd_white, e.not_identifiable, e.active_bound);
        for (auto& w : f.warnings) fmt::print("    warning: {}\n", w);
      }
    }
  } catch (const Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return static_cast<int>(e.kind());
  }
}
