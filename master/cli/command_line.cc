#include "master/cli/command_line.h"

#include <algorithm>
#include <exception>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "sim/base/nearest_name.h"

namespace gauntlet::master {
namespace {

void Configure(CLI::App& app, CommandAction& chosen) {
  app.name("gauntlet");
  app.description(
      "Runs a swarm of robots through evolved obstacle courses until its control algorithm breaks.");
  app.set_version_flag("--version", "gauntlet " GAUNTLET_VERSION);
  app.get_formatter()->column_width(34);
  AddEvolveCommand(app, chosen);
  AddRandomCommand(app, chosen);
  AddEvaluateCommand(app, chosen);
  AddResumeCommand(app, chosen);
  AddShowCommand(app, chosen);
  AddReplayCommand(app, chosen);
  AddListCommand(app, chosen);
  app.footer(
      "\nStart here:\n"
      "  gauntlet evolve flocking          evolve test cases on all cores, about a minute\n"
      "  gauntlet COMMAND --help           options and examples of a command\n"
      "\n"
      "Results go to standard output, progress and messages to standard error.\n"
      "Exit codes: 0 done; 1 a check came out negative; 2 usage or configuration; 3 stopped, resumable;\n"
      "4 internal error.");
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
  if (error.get_name() == "ExtrasError") {
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& long_name : option->get_lnames()) options.push_back("--" + long_name);
    }
    for (const std::string& argument : app.remaining(true)) {
      if (!argument.starts_with("--"))
        return fmt::format("{}unexpected argument '{}' {}", place, argument, help);
      const std::string unknown = argument.substr(0, argument.find('='));
      return fmt::format("{}unknown option {}{} {}", place, unknown, Suggestion(Nearest(unknown, options)),
                         help);
    }
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

}  // namespace

ExitCode RunCommandLine(const std::vector<std::string>& arguments, CommandContext& context) {
  try {
    CommandAction chosen;
    const ExitCode parsed = Parse(arguments, context, chosen);
    return chosen ? chosen(context) : parsed;
  } catch (const std::exception& error) {
    PrintMessage(context, fmt::format("internal error: {}", error.what()));
    return kExitInternal;
  }
}

}  // namespace gauntlet::master
