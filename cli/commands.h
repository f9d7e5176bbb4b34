// The commands of gauntlet, and what a command needs to set itself up: its options, its help, its action.
#pragma once

#include <functional>
#include <utility>

#include "cli/command_line.h"

namespace CLI {
class App;
}

namespace gauntlet {

using CommandAction = std::function<Result<ExitCode>(CommandContext&)>;

// The command line while it is set up.
class CommandParser {
 public:
  // `chosen` is set to the action of the command that is found when `app` parses. Both must outlive this.
  CommandParser(CLI::App& app, CommandAction& chosen) : app_(app), chosen_(chosen) {}

  // A new subcommand, to which the caller adds its options, and where their values go. When the command is
  // chosen, its action calls `run` with these values.
  template <typename Options>
  std::pair<CLI::App&, Options&> Add(const char* name, const char* description,
                                     Result<ExitCode> (*run)(CommandContext&, const Options&)) {
    const auto options = std::make_shared<Options>();
    CLI::App& command = AddSubcommand(
        name, description, [options, run](CommandContext& context) { return run(context, *options); });
    return {command, *options};
  }

 private:
  CLI::App& AddSubcommand(const char* name, const char* description, CommandAction action);

  CLI::App& app_;
  CommandAction& chosen_;
};

void AddExamine(CommandParser& parser);
void AddEvolve(CommandParser& parser);
void AddRandom(CommandParser& parser);
void AddResume(CommandParser& parser);
void AddShow(CommandParser& parser);
void AddReplay(CommandParser& parser);
void AddQuestions(CommandParser& parser);  // one for each of question_table.h
void AddCorpus(CommandParser& parser);
void AddCompare(CommandParser& parser);
void AddReport(CommandParser& parser);
void AddFigure(CommandParser& parser);
void AddUi(CommandParser& parser);
void AddExport(CommandParser& parser);
void AddImport(CommandParser& parser);
void AddStudy(CommandParser& parser);
void AddTune(CommandParser& parser);
void AddFit(CommandParser& parser);
void AddMargin(CommandParser& parser);
void AddProbability(CommandParser& parser);
void AddRepair(CommandParser& parser);
void AddAdopt(CommandParser& parser);
void AddBuildController(CommandParser& parser);
void AddSubmit(CommandParser& parser);
void AddMaster(CommandParser& parser);
void AddStatus(CommandParser& parser);
void AddWatch(CommandParser& parser);
void AddStop(CommandParser& parser);
void AddList(CommandParser& parser);

// In the order of `gauntlet --help`.
inline constexpr void (*kCommands[])(CommandParser&) = {AddExamine,     AddEvolve,
                                                        AddRandom,      AddResume,
                                                        AddShow,        AddReplay,
                                                        AddQuestions,   AddMargin,
                                                        AddProbability, AddRepair,
                                                        AddCorpus,      AddCompare,
                                                        AddStudy,       AddTune,
                                                        AddFit,         AddReport,
                                                        AddUi,          AddFigure,
                                                        AddExport,      AddImport,
                                                        AddAdopt,       AddBuildController,
                                                        AddSubmit,      AddMaster,
                                                        AddStatus,      AddWatch,
                                                        AddStop,        AddList};

}  // namespace gauntlet
