#include "master/cli/command_line.h"

#include <algorithm>
#include <exception>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "master/cli/commands.h"

namespace gauntlet::master {
namespace {

void Configure(CLI::App& app, CommandAction& chosen) {
  app.name("gauntlet");
  app.description(
      "Runs a swarm of robots through evolved obstacle courses until its control algorithm breaks.");
  app.set_version_flag("--version", "gauntlet " GAUNTLET_VERSION);
  app.get_formatter()->column_width(34);
  CommandParser parser(app, chosen);
  for (const auto add : kCommands) add(parser);
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
      if (option->get_group().empty()) continue;  // refused
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

// The action of the command that the arguments ask for; nothing when the answer, help or an error, has been
// given already: `exit_code`.
CommandAction Parse(const std::vector<std::string>& arguments, CommandContext& context, ExitCode& exit_code) {
  CLI::App app;
  CommandAction chosen;
  Configure(app, chosen);
  app.require_subcommand(1);
  exit_code = kExitDone;
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    return chosen;
  } catch (const CLI::CallForHelp&) {
    context.out << app.help() << std::flush;
  } catch (const CLI::CallForVersion& version) {
    context.out << version.what() << std::endl;
  } catch (const CLI::ParseError& error) {
    exit_code = Fail(context, InvalidInput(Explain(app, error, arguments)));
  }
  return nullptr;
}

}  // namespace

CLI::App& CommandParser::AddSubcommand(const char* name, const char* description, CommandAction action) {
  CLI::App* command = app_.add_subcommand(name, description);
  command->callback([&chosen = chosen_, action = std::move(action)] { chosen = action; });
  return *command;
}

ExitCode RunCommandLine(const std::vector<std::string>& arguments, CommandContext& context) {
  try {
    std::vector<std::string> words = arguments;
    if (!words.empty() && words.front() == "help") {  // "help evolve" is "evolve --help"
      words.erase(words.begin());
      words.emplace_back("--help");
    }
    ExitCode exit_code = kExitDone;
    const CommandAction action = Parse(words, context, exit_code);
    return action ? action(context) : exit_code;
  } catch (const std::exception& error) {
    PrintMessage(context, fmt::format("internal error: {}", error.what()));
    return kExitInternal;
  }
}

}  // namespace gauntlet::master
