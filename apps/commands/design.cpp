// cablefit design: what a preload buys, and which motion to record.
#include <fmt/format.h>

#include <filesystem>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "cablefit/report/documents/design_document.hpp"
#include "cablefit/results/design_models.hpp"
#include "cablefit/results/elastic_models.hpp"
#include "cablefit/results/write/design_json.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kDesignExample =
    "Example, after 'cablefit elastic' and 'cablefit dynamic':\n"
    "  cablefit design cablefit-out/dynamic.json --preload low --torque 40 --l-o 0,0.00512\n"
    "A rig file does as well, when its cables have \"coefficients\". Friction against the "
    "preload,\n"
    "from the fits of several preloads:\n"
    "  cablefit design cablefit-out/identify.json --torque 40 --report design.html\n"
    "Which motion to record:\n"
    "  cablefit design cablefit-out/dynamic.json --preload low --excite reference.csv \\\n"
    "    --max-position 0.5 --max-speed 3 --max-torque 100 --load 30\n";

constexpr const char* kResultFile = "design.json";
constexpr std::size_t kMostValues = 200;

/// Stiffness matrices, the nearest preload in equilibrium, constant loads.
struct AsTheyAre {
  bool stiffness = false, balance = false;
  std::string pose, along;  ///< "q,..:theta,.."; a log
  std::string hold;         ///< "T,T" or "T1:T2,T1:T2"
  double max_tension = 0;   ///< N; 0: not asked for

  bool any() const {
    return stiffness || balance || !pose.empty() || !along.empty() || !hold.empty() ||
           max_tension > 0;
  }
};

struct DesignCommand {
  CommonOptions common;
  DesignOptions design;
  std::vector<std::string> models;
  std::string model;  ///< --model
  std::vector<std::string> fitted;
  AsTheyAre cables;
  ExcitationOptions excitation;
  std::string excite;  ///< file; empty: none
};

/// "0,0.002,0.005" or "0:0.01:11", from, to and how many.
std::vector<double> parse_list(const std::string& option, const std::string& text, Range range) {
  std::vector<double> values;
  if (text.find(':') == std::string::npos) {
    for (const std::string& part : parts_of(text, ','))
      values.push_back(parse_number(option, part, range));
    if (values.size() <= kMostValues) return values;
    throw usage_error(fmt::format("{} has {} values", option, values.size()),
                      fmt::format("give at most {}", kMostValues));
  }
  const std::vector<std::string> parts = parts_of(text, ':');
  if (parts.size() != 3)
    throw usage_error(fmt::format("{} cannot be {}", option, in_quotes(text)),
                      "give FROM:TO:N, how many values from where to where, or a list A,B,C");
  const double from = parse_number(option, parts[0], range);
  const double to = parse_number(option, parts[1], range);
  const long n = parse_whole(option, parts[2], {2, static_cast<double>(kMostValues)});
  for (long i = 0; i < n; ++i)
    values.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(n - 1));
  return values;
}

void add_list(CLI::App& app, const std::string& name, const std::string& unit, Range range,
              std::vector<double>& values, const std::string& help) {
  app.add_option_function<std::string>(
         name,
         [&values, name, range](const std::string& text) {
           values = parse_list(name, text, range);
         },
         help)
      ->type_name(unit);
}

void add_model_options(CLI::App& app, DesignCommand& command) {
  app.add_option("MODEL", command.models,
                 "model file, result of 'cablefit elastic', 'dynamic' or 'identify', or rig file "
                 "whose cables "
                 "have coefficients")
      ->type_name("");
  add_choice_of_fit(app, command.model, command.common.preload, "the only one, else the first");
  app.add_option("--fitted", command.fitted,
                 "results of 'cablefit dynamic' or 'identify', whose preloads say how friction "
                 "depends on the preload [those of MODEL]")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void add_sweep_options(CLI::App& app, DesignOptions& design) {
  add_number(
      app, "--torque", "N_M", {1e-9}, [&design](double torque) { design.torque = torque; },
      "the joint works from -torque to torque");
  add_list(app, "--l-o", "L,L,..|FROM:TO:N", {0}, design.l_o,
           "initial elongations of the first cable, m (rad in joint space); the others "
           "are kept in equilibrium [0, and values around what --torque needs]");
  add_list(app, "--radius", "X,X,..|FROM:TO:N", {1e-6}, design.radius_factors,
           "pulley radii, times the rig's [1]");
  app.add_option_function<std::string>(
         "--order",
         [&design](const std::string& text) {
           design.orders.clear();
           for (const std::string& part : parts_of(text, ','))
             design.orders.push_back(
                 static_cast<int>(parse_whole("--order", part, {1, kMaxCableOrder})));
         },
         "orders of the cables of simpler models; 1: piecewise linear [1]")
      ->type_name("N,N,..");
  add_number(
      app, "--tension-friction", "MU", {0}, [&design](double mu) { design.tension_friction = mu; },
      "dry friction per cable force at the motor's pulleys, N m per N m, beside the model's");
}

void add_cable_options(CLI::App& app, AsTheyAre& cables) {
  app.add_flag("--stiffness", cables.stiffness,
               "stiffness matrices of joints and cables at rest, eigenvalues, passivity");
  app.add_option("--pose", cables.pose, "the same at a pose, rad, theta as logged")
      ->type_name("Q,..:THETA,..");
  app.add_option("--along", cables.along, "stiffness over the samples of a log")->type_name("LOG");
  app.add_flag("--balance", cables.balance,
               "the nearest preload in equilibrium, (8c), to the model's own");
  add_number(
      app, "--max-tension", "N", {1e-9, 1e9}, [&cables](double f) { cables.max_tension = f; },
      "torques of the links that cables up to this tension make, at rest and at --pose: vertices, "
      "force closure, and which cable goes slack first (N m in joint space)");
  app.add_option("--hold", cables.hold,
                 "constant loads on the link, N m, motors held: deflection, and elongation of each "
                 "cable; several joints: T1:T2:..,..")
      ->type_name("T,T,..");
}

void add_collision_options(CLI::App& app, DesignOptions& design) {
  add_number(
      app, "--noise", "N_M", {0}, [&design](double noise) { design.noise = noise; },
      "sd of the white torque noise, for collisions [the residual of the fit, else "
      "the rig's sensor tau]");
  add_number(
      app, "--floor", "N_M", {0}, [&design](double floor) { design.floor = floor; },
      "largest torque error of the cable model, from stage 1; added to the error of "
      "every model, for collisions [0]");
  add_number(
      app, "--window", "S", {1e-4, 60}, [&design](double seconds) { design.window = seconds; },
      "averaging time of the collision detector [0.05]");
  add_number(
      app, "--rate", "HZ", {1e-3}, [&design](double rate) { design.rate = rate; },
      "sample rate, for collisions and for --excite [1000]");
  add_number(
      app, "--false-alarms", "PER_HOUR", {1e-9, 3600},
      [&design](double n) { design.false_alarms_per_hour = n; },
      "false alarms of the collision detector [1]");
  add_number(
      app, "--detection-rate", "P", {0.5, 0.999999},
      [&design](double p) { design.detection_rate = p; },
      "probability that it detects the smallest collision [0.99]");
}

void add_excitation_options(CLI::App& app, DesignCommand& command) {
  ExcitationOptions& excitation = command.excitation;
  ExcitationLimits& limits = excitation.limits;
  app.add_option("--excite", command.excite,
                 "write the reference trajectory (CSV) that determines the parameters of stage "
                 "2 best, within the limits below")
      ->type_name("FILE");
  std::vector<std::string> shapes;
  for (const MotionShape& shape : motion_shapes()) shapes.emplace_back(shape.name);
  add_choice(
      app, "--shape", "shape", shapes,
      [&excitation](const std::string& name) { excitation.shape = name; }, "of it [multisine]");
  add_number(
      app, "--max-position", "RAD", {1e-9}, [&limits](double x) { limits.max_position = x; },
      "on either side of --middle");
  add_number(
      app, "--max-speed", "RAD_S", {1e-9}, [&limits](double x) { limits.max_speed = x; },
      "of motor and link");
  add_number(
      app, "--max-torque", "N_M", {1e-9}, [&limits](double x) { limits.max_torque = x; },
      "of the motor");
  add_number(
      app, "--duration", "S", {0.5, 600}, [&limits](double x) { limits.duration = x; },
      "of the reference [16]");
  app.add_option_function<std::string>(
         "--middle",
         [&limits](const std::string& text) {
           limits.middle = parse_number("--middle", text, {-kUnbounded, kUnbounded});
         },
         "position that the motion is around [0]")
      ->type_name("RAD");
  app.add_option_function<std::string>(
         "--load",
         [&limits](const std::string& text) {
           limits.load = parse_number("--load", text, {-kUnbounded, kUnbounded});
         },
         "known torque on the link, where the rig has no law for it [0]")
      ->type_name("N_M");
}

std::string take_model(const DesignCommand& command) {
  if (command.models.size() == 1) return command.models.front();
  throw usage_error(command.models.empty() ? "no model given" : "more than one model given",
                    "name one model file, result or rig file");
}

void check_sweep(const DesignOptions& design) {
  if (false_alarm_rate_of(design.false_alarms_per_hour, design.window) >= design.detection_rate)
    throw usage_error("--false-alarms is so high that every window is a false alarm",
                      "lower --false-alarms or --window");
}

void check_limits(const DesignCommand& command) {
  const ExcitationLimits& limits = command.excitation.limits;
  if (limits.max_position > 0 && limits.max_speed > 0 && limits.max_torque > 0) return;
  throw usage_error("--excite needs limits",
                    "give --max-position, --max-speed and --max-torque of the joint");
}

/// Rows of a reference: fewer determine nothing, more make the search take minutes.
void check_rows(const DesignCommand& command) {
  constexpr double kFewest = 200, kMost = 200000;
  const double rows = command.design.rate * command.excitation.limits.duration;
  if (rows >= kFewest && rows <= kMost) return;
  throw usage_error(fmt::format("a reference of {:.4g} rows", rows),
                    fmt::format("--rate times --duration may be {} to {}", kFewest, kMost));
}

/// The reference never replaces what it is made from, nor another result of the same run.
void check_excite(const DesignCommand& command, const std::string& model) {
  if (command.excite.empty()) return;
  const CommonOptions& options = command.common;
  std::vector<std::string> others = options.reports;
  others.insert(others.end(),
                {model, options.json, (std::filesystem::path(options.out) / kResultFile).string()});
  const auto whole = [](const std::string& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file));
  };
  for (const std::string& other : others)
    if (!other.empty() && whole(other) == whole(command.excite))
      throw usage_error(fmt::format("the reference would overwrite {}", in_quotes(other)),
                        "choose another --excite");
}

Eigen::VectorXd parse_angles(const std::string& text, int n_joints) {
  const std::vector<std::string> parts = parts_of(text, ',');
  if (static_cast<int>(parts.size()) != n_joints)
    throw usage_error(fmt::format("--pose has {} angles where the model has {} joint{}",
                                  parts.size(), n_joints, n_joints == 1 ? "" : "s"),
                      "give Q1,Q2,..:THETA1,THETA2,..");
  Eigen::VectorXd angles(n_joints);
  for (int k = 0; k < n_joints; ++k)
    angles(k) =
        parse_number("--pose", parts[static_cast<std::size_t>(k)], {-kUnbounded, kUnbounded});
  return angles;
}

PoseStiffness at_pose(const Transmission& transmission, const std::string& text) {
  const std::vector<std::string> sides = parts_of(text, ':');
  if (sides.size() != 2)
    throw usage_error(fmt::format("--pose cannot be {}", in_quotes(text)),
                      "give Q1,Q2,..:THETA1,THETA2,..");
  return stiffness_at_pose(transmission, "at the pose",
                           parse_angles(sides[0], transmission.n_joints),
                           parse_angles(sides[1], transmission.n_joints));
}

StiffnessAlong along_log(DesignCommand& command, const Transmission& transmission) {
  CommonOptions options = command.common;
  options.logs = {command.cables.along};
  command.common.more_inputs.push_back(command.cables.along);
  return stiffness_along(transmission, read_logs(options).front(), options.samples.threads);
}

/// One torque per joint: "10" or "0.5:0.2".
Eigen::VectorXd parse_load(const std::string& option, const std::string& text, int n_joints) {
  const std::vector<std::string> parts = parts_of(text, ':');
  if (static_cast<int>(parts.size()) != n_joints)
    throw usage_error(
        fmt::format("{} has {} torque{} where the model has {} joint{}", option, parts.size(),
                    parts.size() == 1 ? "" : "s", n_joints, n_joints == 1 ? "" : "s"),
        "give one torque per joint, T1:T2:.., several loads with commas");
  Eigen::VectorXd load(n_joints);
  for (int k = 0; k < n_joints; ++k)
    load(k) = parse_number(option, parts[static_cast<std::size_t>(k)], {-kUnbounded, kUnbounded});
  return load;
}

void describe_loads(DesignCommand& command, const Model& model, bool figures,
                    DesignResult& result) {
  if (command.cables.hold.empty()) return;
  command.design.figures = figures;
  for (const std::string& load : parts_of(command.cables.hold, ','))
    command.design.held_loads.push_back(parse_load("--hold", load, model.transmission.n_joints));
  hold_loads(model, command.design, result);
}

void describe_torques(const DesignCommand& command, const Transmission& transmission,
                      DesignResult& result) {
  const double tension = command.cables.max_tension;
  if (!(tension > 0)) return;
  result.largest_tension = tension;
  result.polytopes = {
      torque_polytope(transmission, "at rest", transmission.reference_q(), tension)};
  if (!command.cables.pose.empty())
    result.polytopes.push_back(torque_polytope(
        transmission, "at the pose", at_pose(transmission, command.cables.pose).q, tension));
  result.slack_orders = slack_orders(transmission, result.polytopes.front());
}

void describe_cables(DesignCommand& command, const Transmission& transmission,
                     DesignResult& result) {
  const AsTheyAre& asked = command.cables;
  if (asked.stiffness) result.stiffness.push_back(stiffness_at_rest(transmission));
  if (!asked.pose.empty()) result.stiffness.push_back(at_pose(transmission, asked.pose));
  if (!asked.along.empty()) result.along = along_log(command, transmission);
  if (asked.balance) result.balance = nearest_balance(transmission);
}

/// A result of stage 1 serves too: its cables, without inertias.
Model take_cables(const std::string& path, const DesignCommand& command, std::string& choice) {
  if (!is_elastic_result(path))
    return read_design_model(path, command.common.preload, command.model, choice);
  Model model = read_elastic_models(path, command.common.preload, command.model, choice).front();
  model.joints.clear();
  require_cables(model, path);
  return model;
}

/// Fits of several preloads, for friction against the preload.
FittedPreloads take_fitted(const std::string& path, DesignCommand& command) {
  if (command.fitted.empty()) return other_preloads(path, command.model);
  const std::vector<std::string>& files = command.fitted;
  command.common.more_inputs.insert(command.common.more_inputs.end(), files.begin(), files.end());
  return {read_fitted_models(files, command.model), {}};
}

DesignResult sweep_with_fits(const std::string& path, const Model& model, DesignCommand& command) {
  FittedPreloads fits = take_fitted(path, command);
  command.design.fitted = std::move(fits.models);
  DesignResult result = sweep_design(model, command.design);
  for (const std::string& preload : fits.left_out)
    result.warnings.push_back("not in the curves against the preload: " + preload);
  return result;
}

void add_inputs(const std::string& path, const DesignCommand& command, DesignResult& result) {
  result.inputs = {{path, sha256_of_file(path), 0}};
  for (const std::string& file : command.fitted)
    if (file != path) result.inputs.push_back({file, sha256_of_file(file), 0});
}

void check_fitted(const DesignCommand& command) {
  if (command.fitted.empty()) return;
  if (command.design.tension_friction)
    throw usage_error(
        "--fitted and --tension-friction both say how friction depends on the preload",
        "give one of them");
  if (command.design.torque == 0)
    throw usage_error("--fitted needs --torque", "give the torque that the joint has to carry");
}

DesignResult run(DesignCommand& command) {
  const std::string path = take_model(command);
  command.common.more_inputs.push_back(path);
  const bool sweep = command.design.torque > 0, excite = !command.excite.empty();
  if (!sweep && !excite && !command.cables.any())
    throw usage_error("neither --torque nor --excite is given",
                      "give the torque that the joint has to carry, or a file for the motion; "
                      "--stiffness, --balance, --hold or --max-tension for the cables as they are");
  if (sweep) check_sweep(command.design);
  check_fitted(command);
  if (excite) {
    check_limits(command);
    check_rows(command);
  }
  check_excite(command, path);
  std::string choice;
  const Model model = take_cables(path, command, choice);
  const bool figures = wants_figures(command.common);
  DesignResult result = blank_design(model);
  if (sweep) {
    const Progress progress(command.common.quiet, "sweeping the preload");
    command.design.figures = figures;
    result = sweep_with_fits(path, model, command);
  }
  describe_cables(command, model.transmission, result);
  describe_loads(command, model, figures, result);
  describe_torques(command, model.transmission, result);
  if (excite) {
    const Progress progress(command.common.quiet, "searching for a motion");
    command.excitation.limits.rate = command.design.rate;
    command.excitation.seed = command.common.seed;
    command.excitation.threads = command.common.samples.threads;
    result.excitation = plan_excitation(model, command.excitation, figures);
    result.excitation_path = command.excite;
  }
  result.model_path = path;
  result.model_choice = choice;
  add_inputs(path, command, result);
  return result;
}

}  // namespace

int run_design(const Arguments& arguments) {
  CLI::App app("Effect of the preload, error of simpler models, and which motion to record.",
               "design");
  DesignCommand command;
  add_model_options(app, command);
  add_sweep_options(app, command.design);
  add_cable_options(app, command.cables);
  add_collision_options(app, command.design);
  add_excitation_options(app, command);
  add_output_options(app, command.common);
  app.footer(kDesignExample);
  if (!parse(app, arguments)) return 0;
  const DesignResult result = run(command);
  std::vector<ResultFile> files = {{kResultFile, design_json(result)}};
  if (result.excitation)
    files.push_back({command.excite, reference_csv(result.excitation->motion), true});
  deliver(command.common, design_document(result), files);
  return 0;
}

}  // namespace cablefit::apps
