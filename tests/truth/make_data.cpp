// cablefit-make-data OUTDIR [--seed N]: writes the shipped example logs, rig files and campaign.
// The output depends on the seed only.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rig.hpp"
#include "tests/support/plain_arm.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace {

namespace fs = std::filesystem;

constexpr double kLoads[] = {30.0, -40.0};  // N m

struct Cell {
  std::string name;
  truth::Rig rig;
};

// "30" or "-40": loads are whole numbers here.
std::string load_name(double load) { return std::to_string(std::lround(load)); }

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::string format(const char* pattern, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

// The CAD values are the paper's; they belong to its rig, not to these logs, and are never fitted
// to.
std::string rig_json(const Cell& cell, const truth::MovingOptions& o) {
  return "{\n  \"schema\": \"cablefit/rig/1\",\n  \"name\": \"simulated ball-screw joint, " +
         cell.name + " preload\",\n  \"preload\": \"" + cell.name +
         "\",\n  \"torque_hold\": \"zoh\",\n  \"load\": {\"type\": \"column\"},\n" +
         "  \"controller\": {\"type\": \"pd\", \"kp\": " + format("%g", o.kp) +
         ", \"kd\": " + format("%g", o.kd) + ", \"limit\": " + format("%g", o.limit) +
         ", \"reference\": \"theta_ref\"},\n  \"sensors\": {\"q\": {\"quantum\": " +
         format("%g", o.quantum_q) +
         "}, \"theta\": {\"quantum\": " + format("%g", o.quantum_theta) +
         "}, \"tau\": {\"noise\": " + format("%g", o.noise_tau) +
         "}},\n  \"cad\": {\"J_link\": 0.3, \"J_motor\": 0.0019}\n}\n";
}

std::string campaign_json(const std::vector<Cell>& cells) {
  std::string rows;
  for (const Cell& cell : cells) {
    const std::string folder = cell.name + "/";
    std::string moving;
    for (const double load : kLoads) {
      moving +=
          (moving.empty() ? "\"" : ", \"") + folder + "moving_load" + load_name(load) + ".csv\"";
    }
    rows += (rows.empty() ? "" : ",\n") + std::string("    {\"rig\": \"") + folder +
            "rig.json\", \"preload\": \"" + cell.name + "\",\n     \"blocked\": [\"" + folder +
            "blocked.csv\"],\n     \"moving\": [" + moving + "]}";
  }
  return "{\n  \"schema\": \"cablefit/campaign/1\",\n"
         "  \"name\": \"simulated joint, two preloads\",\n  \"cells\": [\n" +
         rows +
         "\n  ],\n  \"models\": [\"linear\", \"poly\"],\n  \"estimator\": \"wls\",\n"
         "  \"limits\": {\"rsd_percent\": 25}\n}\n";
}

// Rms of J times the acceleration averaged over a sample (N m).
double rms_inertia_torque(double inertia, const std::vector<double>& velocity, double rate) {
  double sum = 0.0;
  for (std::size_t i = 1; i < velocity.size(); ++i) {
    const double torque = inertia * (velocity[i] - velocity[i - 1]) * rate;
    sum += torque * torque;
  }
  return std::sqrt(sum / static_cast<double>(velocity.size() - 1));
}

// Largest magnitude.
double peak(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest;
}

double share_of_zero(const std::vector<double>& values) {
  return static_cast<double>(std::count(values.begin(), values.end(), 0.0)) /
         static_cast<double>(values.size());
}

double share_in_closure(const truth::Rig& rig, const truth::Truth& t) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < t.q.size(); ++i)
    count += rig.in_closure(t.theta[i] - t.q[i]) ? 1U : 0U;
  return static_cast<double>(count) / static_cast<double>(t.q.size());
}

void print_header() {
  std::printf("%-25s %5s %15s %15s %6s %6s %7s %7s %6s %6s %6s %6s %7s\n", "log", "s", "phi mrad",
              "tau_elas N m", "tau", "q rad", "thetad", "qd", "Jm*a", "Jl*a", "close%", "restM%",
              "restL%");
}

void print_row(const std::string& name, const truth::Rig& rig, const truth::CommonOptions& o,
               const truth::Truth& t) {
  std::vector<double> phi;
  for (std::size_t i = 0; i < t.q.size(); ++i) phi.push_back(t.theta[i] - t.q[i]);
  const auto [phi_lo, phi_hi] = std::minmax_element(phi.begin(), phi.end());
  const auto [te_lo, te_hi] = std::minmax_element(t.tau_elas.begin(), t.tau_elas.end());
  std::printf(
      "%-25s %5.1f %7.2f %7.2f %7.2f %7.2f %6.1f %6.3f %7.3f %7.3f %6.2f %6.2f %6.2f %6.2f %7.2f\n",
      name.c_str(), o.duration, 1e3 * *phi_lo, 1e3 * *phi_hi, *te_lo, *te_hi, peak(t.tau),
      peak(t.q), peak(t.thetad), peak(t.qd), rms_inertia_torque(rig.J_motor, t.thetad, o.rate),
      rms_inertia_torque(rig.J_link, t.qd, o.rate), 100.0 * share_in_closure(rig, t),
      100.0 * share_of_zero(t.thetad), 100.0 * share_of_zero(t.qd));
}

void make_blocked(const Cell& cell, const fs::path& folder, std::uint64_t seed) {
  truth::BlockedOptions options;
  options.seed = seed;
  truth::Truth exact;
  const truth::Log log = truth::simulate_blocked(cell.rig, options, &exact);
  truth::write_csv((folder / "blocked.csv").string(), log);
  print_row(cell.name + "/blocked", cell.rig, options, exact);
}

void make_moving(const Cell& cell, const fs::path& folder, double load, std::uint64_t seed) {
  truth::MovingOptions options;
  options.seed = seed;
  options.load = load;
  truth::Truth exact;
  const truth::Log log = truth::simulate_moving(cell.rig, options, &exact);
  const std::string name = "moving_load" + load_name(load);
  truth::write_csv((folder / (name + ".csv")).string(), log);
  print_row(cell.name + "/" + name, cell.rig, options, exact);
}

/// The drive of two joints holds a torque for 1 ms, whatever the rate of a log.
constexpr double kHold = 1e-3;
constexpr const char* kDrive = R"( "torque_hold": "zoh", "torque_period": 0.001,)";

/// Two joints: short logs at low rates, for size.
void make_finger(const fs::path& folder, std::uint64_t seed) {
  const cablefit::test::PlainRig rig = cablefit::test::tendon_finger();
  const auto next = static_cast<unsigned>(seed);
  fs::create_directories(folder);
  write_text(folder / "blocked.csv",
             cablefit::test::blocked_log(rig, {0.1, 0.1}, 50, next, 100, 0, kHold));
  write_text(folder / "moving.csv", cablefit::test::moving_log(rig, 8, next + 1));
  write_text(folder / "rig.json", cablefit::test::rig_text(rig, kDrive) + '\n');
}

/// The same finger with phalanges that move each other and weigh something, from a URDF.
void make_phalanges(const fs::path& folder, std::uint64_t seed) {
  const cablefit::test::PlainRig rig = cablefit::test::phalanges_rig();
  const auto next = static_cast<unsigned>(seed);
  fs::create_directories(folder);
  write_text(folder / "finger.urdf",
             cablefit::test::urdf_text(cablefit::test::phalanges(), "finger"));
  write_text(folder / "blocked.csv",
             cablefit::test::blocked_log(rig, {0.1, 0.1}, 40, next, 50, 0, kHold));
  write_text(folder / "moving.csv", cablefit::test::moving_log(rig, 8, next + 1));
  write_text(folder / "rig.json",
             cablefit::test::rig_text(
                 rig, std::string(kDrive) + R"( "arm": {"type": "urdf", "file": "finger.urdf"},)") +
                 '\n');
}

/// Two joints with a pair of cables each, whose preload the rig file does not know.
void make_pairs(const fs::path& folder, std::uint64_t seed) {
  const cablefit::test::PlainRig rig = cablefit::test::four_cable_finger();
  const auto next = static_cast<unsigned>(seed);
  fs::create_directories(folder);
  write_text(folder / "blocked.csv", cablefit::test::blocked_log(rig, {0, 0}, 50, next, 100));
  write_text(folder / "moving.csv", cablefit::test::moving_log(rig, 8, next + 1));
  write_text(folder / "rig.json", cablefit::test::rig_text(rig, "", true) + '\n');
}

void make_data(const fs::path& out, std::uint64_t seed) {
  const std::vector<Cell> cells{{"low", truth::Rig::low()}, {"high", truth::Rig::high()}};
  print_header();
  for (const Cell& cell : cells) {
    const fs::path folder = out / cell.name;
    fs::create_directories(folder);
    make_blocked(cell, folder, seed++);
    for (const double load : kLoads) make_moving(cell, folder, load, seed++);
    write_text(folder / "rig.json", rig_json(cell, truth::MovingOptions{}));
  }
  write_text(out / "campaign.json", campaign_json(cells));
  make_finger(out / "two_joints" / "finger", seed);
  make_phalanges(out / "two_joints" / "phalanges", seed + 2);
  make_pairs(out / "two_joints" / "pairs", seed + 4);
}

std::uint64_t parse_seed(std::string_view text) {
  std::uint64_t seed = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    throw std::invalid_argument("--seed needs a whole number, not '" + std::string(text) + "'");
  }
  return seed;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string_view> args(argv + 1, argv + argc);
  const bool seeded = args.size() == 3 && args[1] == "--seed";
  if (!seeded && args.size() != 1) {
    std::fprintf(stderr, "usage: cablefit-make-data OUTDIR [--seed N]\n");
    return 2;
  }
  try {
    make_data(fs::path(args[0]), seeded ? parse_seed(args[2]) : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cablefit-make-data: %s\n", error.what());
    return 5;
  }
  return 0;
}
