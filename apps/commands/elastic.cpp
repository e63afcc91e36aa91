// cablefit elastic: stage 1.
#include "cablefit/elastic/elastic_fit.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/identify/elastic_search.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/prove/prove.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/json/elastic_json.hpp"
#include "cablefit/session/stages.hpp"
#include "commands/command.hpp"
#include "commands/command_line.hpp"
#include "commands/delivery.hpp"
#include "commands/elongation_option.hpp"
#include "commands/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kElasticExample =
    "Example:\n"
    "  cablefit elastic data/low/blocked.csv data/high/blocked.csv --report table1.md\n";

void add_elastic_options(CLI::App& app, ElasticOptions& elastic, ElongationMode& elongations,
                         bool& order_auto) {
  const auto take_order = [&elastic, &order_auto](const std::string& text) {
    elastic.order = 0;
    order_auto = text == "auto";
    if (order_auto) return;
    elastic.order = static_cast<int>(parse_whole("--order", text, {1, kMaxCableOrder}));
  };
  app.add_option_function<std::string>(
         "--order", take_order,
         "order of the cables' force; auto: the lowest that held-out blocks support")
      ->type_name("N|auto");
  add_whole(
      app, "--max-order", "N", {1, kMaxCableOrder},
      [&elastic](long n) { elastic.max_order = static_cast<int>(n); },
      "highest order that auto tries [6]");
  app.add_flag("--still", elastic.still, "also use moving logs, where their link stands still");
  add_choice(
      app, "--zero", "zero", {"auto", "offset", "theta_0"},
      [&elastic](const std::string& name) {
        elastic.zero = name == "offset"    ? ZeroMode::offset
                       : name == "theta_0" ? ZeroMode::theta_0
                                           : ZeroMode::automatic;
      },
      "what is unknown: the drive's offset, or the encoder's zero");
  add_elongation_option(app, elongations);
  app.add_flag("--unconstrained", elastic.unconstrained,
               "plain least squares: let cables push, with a warning");
  add_number(
      app, "--materiality", "PERCENT", {0, 100},
      [&elastic](double percent) { elastic.materiality = percent / 100; },
      "of the peak torque: a smaller difference between models does not matter [1]");
}

/// The search fits all preloads together, with one order and theta - q as it is.
void require_searchable(const ElasticOptions& elastic, bool order_auto) {
  if (elastic.zero == ZeroMode::theta_0)
    throw usage_error(
        "--zero theta_0 and a search of l_o cannot be combined",
        "find theta_0 with l_o given, and put it in the rig file (\"shift\" of theta)");
  if (order_auto)
    throw usage_error("--order auto and a search of l_o cannot be combined",
                      "give the order, or leave it at 2");
}

/// --prove: fills in what simulated logs say of the fits.
void prove(const CommonOptions& common, const std::vector<LogSurvey>& logs,
           const ElasticOptions& elastic, std::size_t n_runs, ElasticResult& result) {
  Progress display(common.quiet, "proving");
  ProveOptions options;
  options.n_runs = n_runs;
  options.seed = common.seed;
  options.threads = common.samples.threads;
  options.progress = [&display](std::size_t done, std::size_t of) {
    display.rename(fmt::format("proving: run {} of {}", done, of));
  };
  prove_elastic(logs, elastic, options, result);
}

}  // namespace

int run_elastic(const Arguments& arguments) {
  CLI::App app("Stage 1: torque against deflection while the link is blocked.", "elastic");
  CommonOptions options;
  ElasticOptions elastic;
  add_log_options(app, options);
  ElongationMode elongations = ElongationMode::automatic;
  bool order_auto = false;
  std::size_t n_prove = 0;
  add_elastic_options(app, elastic, elongations, order_auto);
  add_whole(
      app, "--prove", "N", {20, 100000},
      [&n_prove](long n) { n_prove = static_cast<std::size_t>(n); },
      "rerun the fit on N simulated logs of its own model: do the intervals cover?");
  add_sd_option(app, options);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kElasticExample);
  if (!parse(app, arguments)) return 0;
  const bool search = elongations == ElongationMode::search;
  if (search && elastic.still)
    throw usage_error("--l-o search and --still cannot be combined",
                      "a moving log belongs to 'cablefit identify'");

  const std::vector<LogSurvey> logs = read_logs(options);
  elastic.samples = options.samples;
  elastic.preload = options.preload;
  elastic.honest_sd = options.honest_sd;
  elastic.figures = wants_figures(options);
  const std::vector<LogSurvey> blocked = elastic.still ? logs : logs_of(logs, Phase::blocked);
  const bool searches = !blocked.empty() && !elastic.still &&
                        elongations != ElongationMode::known && (search || wants_search(blocked));
  if (searches) require_searchable(elastic, order_auto);
  if (searches && n_prove > 0)
    throw usage_error("--prove and a search of l_o cannot be combined",
                      "the intervals of l_o are profile likelihoods; prove a fit with l_o given");
  // Without any blocked log the fit says what to do, for the logs that were given.
  ElasticResult result = or_why(logs, [&] {
    const Progress progress(options.quiet, "fitting stage 1");
    return fit_elastic_stage(blocked.empty() ? logs : blocked, elastic, elongations);
  });
  if (n_prove > 0) prove(options, blocked, elastic, n_prove, result);
  deliver(options, elastic_document(result), {{"elastic.json", elastic_json(result)}});
  return 0;
}

}  // namespace cablefit::apps
