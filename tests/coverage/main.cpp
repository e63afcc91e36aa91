// Runs one cell of the coverage table and prints a line per run and parameter; scripts/coverage
// makes the table.
//
//   coverage-cell --estimator wls --noise coloured --bits 16 --loop closed --gains soft
//                 --runs 400 --seed 1 --seconds 20
#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "tests/coverage/cell.hpp"

int main(int argc, char** argv) {
  using namespace cablefit::coverage;
  CLI::App app("One cell of the coverage table: a line per run and parameter on stdout.");
  Cell cell;
  std::string noise = "coloured", loop = "closed", gains = "soft";
  unsigned n_runs = 400;
  app.add_option("--estimator", cell.estimator, "see 'cablefit list estimators'");
  app.add_option("--noise", noise)->check(CLI::IsMember({"white", "coloured"}));
  app.add_option("--bits", cell.bits, "of the encoder")->check(CLI::Range(8, 30));
  app.add_option("--loop", loop)->check(CLI::IsMember({"open", "replay", "closed"}));
  app.add_option("--gains", gains)->check(CLI::IsMember({"soft", "stiff"}));
  app.add_option("--runs", n_runs);
  app.add_option("--seed", cell.seed, "of the first run; counted up from there");
  app.add_option("--seconds", cell.duration, "of a log");
  CLI11_PARSE(app, argc, argv);
  cell.coloured = noise == "coloured";
  cell.loop = loop == "open" ? Loop::open : loop == "replay" ? Loop::replay : Loop::closed;
  cell.stiff = gains == "stiff";
  fmt::print("seed,parameter,truth,value,sd,ci_low,ci_high\n");
  for (unsigned run = 0; run < n_runs; ++run, ++cell.seed)
    for (const CellRow& row : run_cell(cell)) {
      const cablefit::Estimate& e = row.estimate;
      fmt::print("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", row.seed, e.name, row.truth, e.value,
                 e.sd, e.ci_low, e.ci_high);
    }
}
