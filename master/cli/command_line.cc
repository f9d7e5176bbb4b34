#include "master/cli/command_line.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "master/cli/commands.h"
#include "slurm/slurm_settings.h"

namespace gauntlet::master {
namespace {

void AddMessageOptions(CLI::App& command, CommonOptions& options) {
  command.add_flag("--json", options.json, "the result as one JSON document on standard output");
  command.add_flag("--quiet", options.quiet, "no progress and no messages but errors");
  command.add_flag("--no-progress", options.no_progress, "messages, but no progress");
}

void AddAuditOption(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--audit", options.audit,
                  "share of runs, 0 to 1, that a second worker simulates too; a difference is told (default: "
                  "0; not kept: "
                  "tell `resume` too)")
      ->type_name("P");
}

void AddMetricsOption(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--metrics-port", options.metrics_port,
                  "serve Prometheus metrics on this port of 127.0.0.1 (0: any free one)")
      ->type_name("PORT");
}

void AddRunningOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--workers", options.workers, "worker processes on this machine (default: its cores)")
      ->type_name("N");
  AddAuditOption(command, options);
  AddMetricsOption(command, options);
  AddMessageOptions(command, options);
}

void AddBindOptions(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--bind", options.bind,
                  "where workers connect: tcp://ADDRESS:PORT (IPv4, 0.0.0.0: all; port *: any free one) or "
                  "ipc://PATH")
      ->type_name("ENDPOINT");
  command.add_flag("--insecure", options.insecure,
                   "plaintext, open to everybody, also on an address that other machines can reach");
}

void AddExperimentOptions(CLI::App& command, CommonOptions& options) {
  command
      .add_option("EXPERIMENT", options.experiment,
                  "a shipped experiment (see: gauntlet list experiments), or a TOML file")
      ->required();
  command
      .add_option("--dir", options.directory,
                  "directory of the campaign, new or empty (default: campaigns/EXPERIMENT-<UTC time>)")
      ->type_name("DIR");
  command.add_option("--seed", options.seed, "seed of the campaign (default: the experiment's, 1)")
      ->type_name("S|random");
  command
      .add_option(
          "--set", options.sets,
          "change one value of the experiment, e.g. --set search.mutation_probability=0.1; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--generations", options.generations, "short for --set search.generations=G")
      ->type_name("G");
  command.add_option("--population", options.population, "short for --set search.population=P")
      ->type_name("P");
}

void AddCommonOptions(CLI::App& command, CommonOptions& options) {
  AddExperimentOptions(command, options);
  AddRunningOptions(command, options);
}

// A command with its options, which live as long as its action. `run` is called when the command was chosen.
template <typename Options>
std::pair<CLI::App*, Options*> AddCommand(CLI::App& app, CommandAction& chosen, const char* name,
                                          const char* description,
                                          ExitCode (*run)(CommandContext&, const Options&)) {
  CLI::App* command = app.add_subcommand(name, description);
  const auto options = std::make_shared<Options>();
  command->callback([options, run, &chosen] {
    chosen = [options, run](CommandContext& context) { return run(context, *options); };
  });
  return {command, options.get()};
}

void AddSearchCommands(CLI::App& app, CommandAction& chosen) {
  const auto [evolve, evolve_options] =
      AddCommand(app, chosen, "evolve", "evolve test cases in which the swarm fails", RunEvolve);
  AddCommonOptions(*evolve, *evolve_options);
  evolve->footer(
      R"(Evolves test cases with the experiment's search on a local pool of workers, shows progress, and ends
with a table of the toughest cases. Ctrl-C stops cleanly (exit 3); 'gauntlet resume DIR' goes on.
Same experiment, settings and seed: same result, whatever the number of workers.

Examples:
  gauntlet evolve flocking
  gauntlet evolve flocking --generations 100 --workers 8 --dir campaigns/long
  gauntlet evolve flocking --seed random --set search.crossover=uniform --json > result.json
  gauntlet evolve my-experiment.toml --set controller_parameters.bird_speed=0.1)");

  const auto [random, random_options] = AddCommand(
      app, chosen, "random", "random test cases: the baseline to hold an evolution against", RunRandom);
  AddCommonOptions(*random, random_options->common);
  random
      ->add_option("--cases", random_options->cases,
                   "how many test cases (default: the experiment's search.cases)")
      ->type_name("N");
  random->footer(
      R"(Generates valid random test cases by the experiment's rules and simulates each once (more often with
--set search.replicates=K). The population that 'show' reports are all cases.

Examples:
  gauntlet random flocking --cases 200
  gauntlet random flocking --cases 1000 --seed 7 --dir campaigns/baseline)");

  const auto [evaluate, evaluate_options] = AddCommand(
      app, chosen, "evaluate", "simulate given test cases (case JSON or .argos files)", RunEvaluate);
  AddCommonOptions(*evaluate, evaluate_options->common);
  evaluate->add_option("--case", evaluate_options->files, "case files, .json or .argos; several may follow")
      ->type_name("FILE...")
      ->required();
  evaluate->add_option("--replicates", evaluate_options->replicates, "runs per case, each with its own seed")
      ->type_name("K");
  evaluate->footer(
      R"(Simulates each case and prints its fitness (mean of the replicates; lower = tougher). A case that
breaks a validity rule is refused by the rule's name; the others go on. Exit 2 when all were refused.
Of .argos files the arena, the boxes, the number of foot-bots and their start area are read.

Examples:
  gauntlet evaluate flocking --case one-wall.json --replicates 20
  gauntlet evaluate flocking-improved --case cases/*.argos --json > improved.json)");
}

void AddCampaignCommands(CLI::App& app, CommandAction& chosen) {
  const auto [resume, resume_options] =
      AddCommand(app, chosen, "resume", "go on with a campaign that was stopped or killed", RunResume);
  resume->add_option("DIR", resume_options->directory, "directory of the campaign")->required();
  AddRunningOptions(*resume, *resume_options);
  AddBindOptions(*resume, *resume_options);
  resume->add_flag(
      "--as-job", resume_options->as_job,
      "for the master's job of a submitted campaign: replaces a twin, leaves workers to its successor");
  resume->footer(
      R"(Goes on where the campaign was, whatever ended it; no finished run is simulated again, and the result
is that of an undisturbed campaign. A finished campaign is only summarised.

With --bind, workers come from elsewhere, as with 'gauntlet master'. A campaign that was submitted to Slurm
goes on there, unless --workers or --bind is given; jobs of it that are left are used.

Examples:
  gauntlet resume campaigns/flocking-20260131T120000Z --workers 4
  gauntlet resume DIR --bind 'tcp://0.0.0.0:*')");

  const auto [show, show_options] = AddCommand(app, chosen, "show", "what came out of a campaign", RunShow);
  show->add_option("DIR", show_options->directory, "directory of the campaign")->required();
  show->add_flag("--json", show_options->json, "everything as one JSON document");
  show->footer(
      R"(Sums up what is stored: runs, fitness by generation, total failures, the toughest cases with a run to
replay, and the state hash, which is equal for equal outcomes.

Examples:
  gauntlet show campaigns/flocking-20260131T120000Z
  gauntlet show DIR --json | jq '.population[0].genome')");

  const auto [replay, replay_options] =
      AddCommand(app, chosen, "replay", "simulate one stored run again, check its hash, draw it", RunReplay);
  replay->add_option("DIR", replay_options->directory, "directory of the campaign")->required();
  replay->add_option("RUN_ID", replay_options->run, "number of the run, as 'show' names it")->required();
  replay
      ->add_option("--svg", replay_options->svg,
                   "write a picture: arena, every robot's way, where the swarm split")
      ->type_name("F");
  replay
      ->add_option("--timeline", replay_options->timeline,
                   "write a picture: what every robot did when (foraging, task-partitioning)")
      ->type_name("F");
  replay->add_option("--csv", replay_options->csv, "write every pose of every tick")->type_name("F");
  replay->add_flag("--json", replay_options->json, "the result as one JSON document");
  replay->footer(
      R"(Same run, same bits: exit 0 when the new hash equals the stored one, 1 when it does not, saying what
differs.

Example:
  gauntlet replay campaigns/flocking-20260131T120000Z 812 --svg run-812.svg --csv run-812.csv)");
}

void AddSubmitCommand(CLI::App& app, CommandAction& chosen) {
  const auto [submit, options] =
      AddCommand(app, chosen, "submit", "a search as jobs of a Slurm cluster", RunSubmit);
  AddExperimentOptions(*submit, options->common);
  AddMessageOptions(*submit, options->common);
  submit
      ->add_option("--master", options->master,
                   "job (default): the master is a job too; here: it runs in this process")
      ->type_name("job|here")
      ->check(CLI::IsMember({"job", "here"}));
  submit
      ->add_option("--slurm", options->slurm,
                   "one setting of the jobs or the pool, e.g. --slurm partition=short; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  submit
      ->add_option(
          "--sweep", options->sweeps,
          "one search for each value, e.g. --sweep search.population=10,20,40; repeatable: all combinations")
      ->type_name("KEY=A,B,...")
      ->allow_extra_args(false);
  submit->add_option("--seeds", options->seeds, "one search for each seed (and each combination of --sweep)")
      ->type_name("1..20|1,5,9");
  submit->add_flag("--dry-run", options->dry_run,
                   "submit nothing: print the scripts and what sbatch --test-only says of them");
  std::string settings;
  for (const SlurmKeyInfo& key : SlurmKeys()) {
    settings += fmt::format("  {:24}{}{}\n", key.name, key.description,
                            key.default_value.empty() ? "" : fmt::format(" (default {})", key.default_value));
  }
  submit->footer(
      R"(Submits the master as a job and returns; the master submits workers as there is work for them, replaces those
that are lost, and cancels them when the search has ended. The campaign's directory must be on a file system
that the compute nodes share. Same experiment and seed: same result as with 'evolve'.

With --sweep and --seeds the campaign holds many searches, which share one pool; each ends like 'evolve' with its
--set and --seed. 'show' tells them apart.

Settings for --slurm, also in the experiment's [slurm] table and in ~/.config/gauntlet/slurm.toml:
)" + settings +
      R"(
Examples:
  gauntlet submit flocking --dir $WORK/flocking-1 --slurm partition=short --slurm max_allocations=20
  gauntlet submit flocking --dry-run
  gauntlet submit flocking --sweep search.mutation_probability=0.02,0.05,0.1 --seeds 1..20
  gauntlet submit flocking --master here --generations 100)");
}

void AddServiceCommands(CLI::App& app, CommandAction& chosen) {
  const auto [master, master_options] =
      AddCommand(app, chosen, "master", "a search whose workers come from elsewhere", RunMaster);
  AddExperimentOptions(*master, master_options->common);
  AddAuditOption(*master, master_options->common);
  AddMessageOptions(*master, master_options->common);
  AddBindOptions(*master, master_options->common);
  AddMetricsOption(*master, master_options->common);
  master->get_option("--bind")->required();
  master->add_flag("--resume", master_options->resume, "go on with the campaign in --dir when there is one");
  master->footer(
      R"(Evolves like 'evolve', but starts no workers: they find the master through access.json in the campaign's
directory ('gauntlet-worker --dir DIR' on any machine that sees it). On an address that other machines can
reach, everything is encrypted and only workers with the keys in access.json are let in. Ctrl-C or SIGTERM
stops the master alone (exit 3): workers finish, keep their results and wait 10 minutes for a successor.
'gauntlet stop DIR' lets the workers go too.

Examples:
  gauntlet master flocking --bind 'tcp://0.0.0.0:*' --dir /shared/flocking-1
  gauntlet master flocking --bind 'tcp://0.0.0.0:*' --dir /shared/flocking-1 --resume)");

  const auto [status, status_options] =
      AddCommand(app, chosen, "status", "what runs where, since when, and why nothing runs", RunStatus);
  const auto [watch, watch_options] =
      AddCommand(app, chosen, "watch", "the status every second, until the campaign's master ends", RunWatch);
  const auto [stop, stop_options] =
      AddCommand(app, chosen, "stop", "let a campaign end what has begun, and stop it", RunStop);
  for (const auto& [command, options] :
       {std::pair{status, status_options}, std::pair{watch, watch_options}, std::pair{stop, stop_options}}) {
    command->add_option("DIR", options->directory, "directory of the campaign")->required();
  }
  status->add_flag("--json", status_options->json, "everything as one JSON document");
  status->footer(
      R"(Read from what the living master writes every second; without one, from what is stored. Of a submitted campaign
it lists the jobs with Slurm's state and reason.

Examples:
  gauntlet status DIR
  gauntlet status DIR --json | jq -r .why_nothing_runs)");
  watch->footer("Example:\n  gauntlet watch DIR");
  stop->footer(
      R"(No more runs are given away; those that have begun end and are stored, workers leave, the master ends
(exit 3). Returns when it is gone. Works from any machine that sees the directory. Of a submitted campaign
all jobs are cancelled, and no others.

Example:
  gauntlet stop DIR)");
}

void AddListCommand(CLI::App& app, CommandAction& chosen) {
  const auto [list, options] =
      AddCommand(app, chosen, "list",
                 "experiments, scenarios, controllers, searches, disturbances; all parameters", RunList);
  list->add_option("SECTION", options->section,
                   "experiments, scenarios, controllers, searches or disturbances (default: all)")
      ->check(CLI::IsMember(kListSections));
  list->add_flag("--json", options->json, "as one JSON document");
  list->footer(R"(Examples:
  gauntlet list experiments
  gauntlet list controllers --json | jq '.controllers[].name')");
}

void Configure(CLI::App& app, CommandAction& chosen) {
  app.name("gauntlet");
  app.description(
      "Runs a swarm of robots through evolved obstacle courses until its control algorithm breaks.");
  app.set_version_flag("--version", "gauntlet " GAUNTLET_VERSION);
  app.get_formatter()->column_width(34);
  AddSearchCommands(app, chosen);
  AddCampaignCommands(app, chosen);
  AddSubmitCommand(app, chosen);
  AddServiceCommands(app, chosen);
  AddListCommand(app, chosen);
  const CLI::Validator given(
      [](const std::string& value) {
        return value.empty() ? std::string("must not be empty") : std::string();
      },
      "");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_expected_max() > 0) option->check(given);  // takes a value
    }
  }
  app.footer(R"(Start here:
  gauntlet evolve flocking          evolve test cases on all cores, about a minute
  gauntlet COMMAND --help           options and examples of a command

Results go to standard output, progress and messages to standard error. An error leaves standard output
empty, also with --json: look at the exit code first. Outcomes that are negative (a run not reproduced, every
case refused) are results and are printed.
Exit codes: 0 done; 1 a check came out negative; 2 usage or configuration; 3 stopped, resumable;
4 internal error, or standard output cannot be written.)");
}

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::string Nearest(std::string_view unknown, const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  return NearestName(unknown, views);
}

std::string Suggestion(const std::string& nearest) {
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

// What is wrong with arguments that the parser refused, for a person.
std::string Explain(const CLI::App& app, const CLI::ParseError& error,
                    const std::vector<std::string>& arguments) {
  const std::vector<std::string> commands = CommandNames(app);
  if (arguments.empty())
    return fmt::format("which command? One of {} (try 'gauntlet --help')", fmt::join(commands, ", "));
  const std::string& name = arguments.front();
  if (!name.starts_with('-') && std::find(commands.begin(), commands.end(), name) == commands.end()) {
    return fmt::format("unknown command '{}'{}", name,
                       Nearest(name, commands).empty()
                           ? fmt::format("; there are {}", fmt::join(commands, ", "))
                           : Suggestion(Nearest(name, commands)));
  }
  const std::vector<CLI::App*> used = app.get_subcommands();
  const CLI::App& command = used.empty() ? app : *used.front();
  const std::string place = used.empty() ? "" : command.get_name() + ": ";
  const std::string help =
      fmt::format("(try 'gauntlet {}--help')", used.empty() ? "" : command.get_name() + " ");
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& long_name : option->get_lnames()) options.push_back("--" + long_name);
    }
    // The parser lists an option's value before the option.
    const std::vector<std::string> extras = app.remaining(true);
    const auto option = std::find_if(extras.begin(), extras.end(),
                                     [](const std::string& extra) { return extra.starts_with("--"); });
    if (option != extras.end()) {
      const std::string unknown = option->substr(0, option->find('='));
      return fmt::format("{}unknown option {}{} {}", place, unknown, Suggestion(Nearest(unknown, options)),
                         help);
    }
    if (!extras.empty()) return fmt::format("{}unexpected argument '{}' {}", place, extras.front(), help);
  }
  return fmt::format("{}{} {}", place, error.what(), help);
}

ExitCode Parse(const std::vector<std::string>& arguments, CommandContext& context, CommandAction& chosen) {
  CLI::App app;
  Configure(app, chosen);
  app.require_subcommand(1);
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(std::move(reversed));
    return kExitDone;
  } catch (const CLI::CallForHelp&) {
    context.out << app.help() << std::flush;
  } catch (const CLI::CallForAllHelp&) {
    context.out << app.help("", CLI::AppFormatMode::All) << std::flush;
  } catch (const CLI::CallForVersion& version) {
    context.out << version.what() << std::endl;
  } catch (const CLI::ParseError& error) {
    chosen = nullptr;
    return Fail(context, InvalidInput(Explain(app, error, arguments)));
  }
  chosen = nullptr;
  return kExitDone;
}

// "help evolve" as "evolve --help".
std::vector<std::string> WithHelpAsOption(std::vector<std::string> arguments) {
  arguments.erase(arguments.begin());
  arguments.emplace_back("--help");
  return arguments;
}

}  // namespace

ExitCode RunCommandLine(const std::vector<std::string>& arguments, CommandContext& context) {
  try {
    CommandAction chosen;
    const bool asks_help = !arguments.empty() && arguments.front() == "help";
    const ExitCode parsed = Parse(asks_help ? WithHelpAsOption(arguments) : arguments, context, chosen);
    return chosen ? chosen(context) : parsed;
  } catch (const std::exception& error) {
    PrintMessage(context, fmt::format("internal error: {}", error.what()));
    return kExitInternal;
  }
}

}  // namespace gauntlet::master
