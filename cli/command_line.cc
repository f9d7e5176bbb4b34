#include "cli/command_line.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/system/resource_limits.h"
#include "cli/commands.h"

namespace gauntlet {
namespace {

void Configure(CLI::App& app, const std::string& version, CommandAction& chosen) {
  app.name("gauntlet");
  app.description("Finds the obstacle courses in which a robot swarm fails.");
  app.set_version_flag("--version", version);
  app.get_formatter()->column_width(34);
  app.require_subcommand(1);
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
  gauntlet COMMAND --help           print the options and examples of a command

Results go to standard output, progress and messages to standard error. After an error, standard output is
empty, also with --json: look at the exit code first. A negative outcome, such as a run that was not reproduced
or cases that were all refused, is a result and is printed.
Exit codes: 0 done; 1 a check came out negative; 2 usage or configuration; 3 stopped, resumable, or the
machine has too little disk space, memory or processes; 4 internal error, or standard output cannot be written.)");
}

// "; did you mean 'evolve'?"; "" when no known name is near.
std::string Suggestion(std::string_view unknown, const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string nearest = NearestName(unknown, views);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

// What is wrong with arguments that the parser refused, for a person.
std::string Explain(const CLI::App& app, const CLI::ParseError& error,
                    const std::vector<std::string>& arguments) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (arguments.empty())
    return fmt::format("which command? One of {} (try 'gauntlet --help')", fmt::join(commands, ", "));
  const std::string& name = arguments.front();
  if (!name.starts_with('-') && std::ranges::count(commands, name) == 0) {
    const std::string suggestion = Suggestion(name, commands);
    return fmt::format(
        "unknown command '{}'{}", name,
        suggestion.empty() ? fmt::format("; there are {}", fmt::join(commands, ", ")) : suggestion);
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
    const auto option =
        std::ranges::find_if(extras, [](const std::string& extra) { return extra.starts_with("--"); });
    if (option != extras.end()) {
      const std::string unknown = option->substr(0, option->find('='));
      return fmt::format("{}unknown option {}{} {}", place, unknown, Suggestion(unknown, options), help);
    }
    if (!extras.empty()) return fmt::format("{}unexpected argument '{}' {}", place, extras.front(), help);
  }
  return fmt::format("{}{} {}", place, error.what(), help);
}

}  // namespace

void PrintMessage(CommandContext& context, std::string_view message) {
  context.err << "gauntlet: " << Printable(message) << std::endl;
}

ExitCode Fail(CommandContext& context, const Error& error) {
  PrintMessage(context, error.message);
  if (error.kind == ErrorKind::kInternal) return kExitInternal;
  return error.kind == ErrorKind::kNoSpace ? kExitStopped : kExitUsage;
}

CLI::App& CommandParser::AddSubcommand(const char* name, const char* description, CommandAction action) {
  CLI::App* command = app_.add_subcommand(name, description);
  command->callback([&chosen = chosen_, action = std::move(action)] { chosen = action; });
  return *command;
}

ExitCode RunCommandLine(const std::vector<std::string>& arguments, CommandContext& context) {
  std::vector<std::string> words = arguments;
  if (!words.empty() && words.front() == "help") {  // "help evolve" is "evolve --help"
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  CLI::App app;
  try {
    CommandAction chosen;
    Configure(app, context.version, chosen);
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    const Result<ExitCode> code = chosen(context);
    return code ? *code : Fail(context, code.error());
  } catch (const CLI::CallForHelp&) {
    context.out << app.help() << std::flush;
    return kExitDone;
  } catch (const CLI::CallForVersion& version) {
    context.out << version.what() << std::endl;
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    return Fail(context, InvalidInput(Explain(app, error, words)));
  } catch (const std::exception& error) {
    if (const std::optional<Error> resources = ErrorOfResources(error)) return Fail(context, *resources);
    PrintMessage(context, fmt::format("internal error: {}", error.what()));
    return kExitInternal;
  }
}

}  // namespace gauntlet
