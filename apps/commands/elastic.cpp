// cablefit elastic: stage 1.
#include "cablefit/elastic/elastic_fit.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/identify/elastic_search.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/prove/prove.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/writers/bases_csv.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "cablefit/session/stages.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/elongation_option.hpp"
#include "options/given_logs.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr Range kAnyNumber = {-kUnbounded, kUnbounded};

constexpr const char* kElasticExample =
    "Example:\n"
    "  cablefit elastic data/low/blocked.csv data/high/blocked.csv --report table1.md\n";

/// "2", "2,1" or "auto".
void take_orders(const std::string& text, ElasticOptions& elastic) {
  elastic.order = 0;
  elastic.orders.clear();
  elastic.choose_orders = text == "auto";
  if (elastic.choose_orders) return;
  for (const std::string& order : parts_of(text, ','))
    elastic.orders.push_back(static_cast<int>(parse_whole("--order", order, {1, kMaxCableOrder})));
  if (elastic.orders.size() > 1) return;
  elastic.order = elastic.orders.front();
  elastic.orders.clear();
}

void add_elastic_options(CLI::App& app, ElasticOptions& elastic, ElongationMode& elongations) {
  app.add_option_function<std::string>(
         "--order", [&elastic](const std::string& text) { take_orders(text, elastic); },
         "order of the cable law, of all or one per cable; auto: of each the lowest that block "
         "cross-validation supports")
      ->type_name("N|N,N,..|auto");
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
      "which constant is estimated: the drive's offset, or the encoder's zero");
  app.add_option_function<std::string>(
         "--offset",
         [&elastic](const std::string& text) {
           elastic.offset.reset();
           if (text == "free") return;
           elastic.offset = text == "zero" ? 0 : parse_number("--offset", text, kAnyNumber);
         },
         "of the drive, N m: estimated, or given; the paper's (29) and (30) have none [free]")
      ->type_name("free|zero|VALUE");
  add_elongation_option(app, elongations);
  app.add_flag("--unconstrained", elastic.unconstrained,
               "plain least squares: allow a negative cable stiffness, with a warning");
  add_number(
      app, "--materiality", "PERCENT", {0, 100},
      [&elastic](double percent) { elastic.materiality = percent / 100; },
      "of the peak torque: a smaller difference between models does not matter [1]");
}

/// "-0.0138:0.0138".
std::pair<double, double> parse_range(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw usage_error(fmt::format("{} cannot be {}", option, in_quotes(text)),
                      "give LOW:HIGH, two deflections in rad");
  const std::pair<double, double> range = {
      parse_number(option, text.substr(0, colon), kAnyNumber),
      parse_number(option, text.substr(colon + 1), kAnyNumber)};
  if (range.first < range.second) return range;
  throw usage_error(fmt::format("{} cannot be {}", option, in_quotes(text)),
                    "the first deflection is the smaller one");
}

/// Fitted with l_o as it is given: the search is one of polynomial cables.
void add_bases_option(CLI::App& app, ElasticOptions& elastic) {
  begin_group(app, "Compare bases of the cable force");
  app.add_flag("--bases", elastic.bases,
               "polynomial, B-splines, wavelets and monotone splines: terms, error on held-out "
               "blocks, and whether k(l) >= 0; with l_o as given, e.g. --l-o known");
}

void add_line_options(CLI::App& app, ComparedLines& lines, std::vector<std::string>& test) {
  begin_group(app, "Score the classical linear model");
  app.add_option_function<std::vector<std::string>>(
         "--linear",
         [&lines](const std::vector<std::string>& given) {
           for (const std::string& k : given)
             lines.stiffnesses.push_back(parse_number("--linear", k, {0}));
         },
         "errors of K (theta - q) with this K over all samples")
      ->type_name("N_M_RAD");
  app.add_option_function<std::vector<std::string>>(
         "--linear-range",
         [&lines](const std::vector<std::string>& given) {
           for (const std::string& range : given)
             lines.ranges.push_back(parse_range("--linear-range", range));
         },
         "the same, K fitted to these deflections alone, rad")
      ->type_name("LOW:HIGH");
  app.add_option("--test", test, "blocked logs on which every model is scored, and none fitted")
      ->type_name("LOG");
}

/// The test logs, read as the others are.
std::vector<LogSurvey> read_test(CommonOptions& common, const std::vector<std::string>& test) {
  if (test.empty()) return {};
  const GivenLogs given[] = {{"the fit", common.logs}, {"--test", test}};
  require_distinct(given);
  CommonOptions options = common;
  options.logs = test;
  common.more_inputs.insert(common.more_inputs.end(), test.begin(), test.end());
  return read_logs(options);
}

/// The search fits all preloads together, with one order and theta - q as it is.
void require_searchable(const ElasticOptions& elastic) {
  if (elastic.offset)
    throw usage_error("--offset and a search of l_o cannot be combined",
                      "give l_o in the rig file, or leave the offset free");
  if (!elastic.lines.empty())
    throw usage_error("scores of straight lines and a search of l_o cannot be combined",
                      "give l_o in the rig file, or choose --l-o known");
  if (elastic.bases)
    throw usage_error("--bases and a search of l_o cannot be combined",
                      "give l_o in the rig file, or choose --l-o known");
  if (elastic.zero == ZeroMode::theta_0)
    throw usage_error(
        "--zero theta_0 and a search of l_o cannot be combined",
        "find theta_0 with l_o given, and put it in the rig file (\"shift\" of theta)");
  if (elastic.choose_orders || !elastic.orders.empty())
    throw usage_error("--order auto or one per cable, and a search of l_o cannot be combined",
                      "give one order, or put the orders into the rig file");
}

/// --prove: fills in the coverage on simulated logs.
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
  std::size_t n_prove = 0;
  add_elastic_options(app, elastic, elongations);
  add_whole(
      app, "--prove", "N", {20, 100000},
      [&n_prove](long n) { n_prove = static_cast<std::size_t>(n); },
      "rerun the fit on N simulated logs of its own model: do the 95 % intervals "
      "contain the true values?");
  add_sd_option(app, options);
  std::vector<std::string> test_paths;
  add_line_options(app, elastic.lines, test_paths);
  add_bases_option(app, elastic);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kElasticExample);
  if (!parse(app, arguments)) return 0;
  const bool search = elongations == ElongationMode::search;
  if (search && elastic.still)
    throw usage_error("--l-o search and --still cannot be combined",
                      "give moving logs to 'cablefit identify'");

  const std::vector<LogSurvey> logs = read_logs(options), test = read_test(options, test_paths);
  elastic.lines.test = test;
  elastic.samples = options.samples;
  elastic.preload = options.preload;
  elastic.robust_sd = options.robust_sd;
  elastic.figures = wants_figures(options);
  const std::vector<LogSurvey> blocked = elastic.still ? logs : logs_of(logs, Phase::blocked);
  const bool of_elongations =
      elongations != ElongationMode::known && (search || wants_search(blocked));
  const bool searches = !blocked.empty() && !elastic.still &&
                        (of_elongations || searches_radius(std::span<const LogSurvey>(blocked)));
  if (searches) require_searchable(elastic);
  if (searches && n_prove > 0)
    throw usage_error("--prove and a search of l_o cannot be combined",
                      "the intervals of l_o are profile likelihoods; prove a fit with l_o given");
  // Without any blocked log the fit says what to do, for the logs that were given.
  ElasticResult result = or_why(logs, [&] {
    const Progress progress(options.quiet, "fitting stage 1");
    return fit_elastic_stage(blocked.empty() ? logs : blocked, elastic, elongations);
  });
  if (n_prove > 0) prove(options, blocked, elastic, n_prove, result);
  std::vector<ResultFile> files = {{"elastic.json", elastic_json(result)}};
  if (elastic.bases) files.push_back({"elastic_bases.csv", bases_csv(result)});
  deliver(options, elastic_document(result), files);
  return 0;
}

}  // namespace cablefit::apps
