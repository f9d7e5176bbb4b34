// The commands of gauntlet. Each is one file: its options, its help, its action.
#pragma once

#include "master/cli/command.h"

namespace gauntlet::master {

void AddEvolve(CommandParser& parser);
void AddRandom(CommandParser& parser);
void AddEvaluate(CommandParser& parser);
void AddResume(CommandParser& parser);
void AddShow(CommandParser& parser);
void AddReplay(CommandParser& parser);
void AddSubmit(CommandParser& parser);
void AddMaster(CommandParser& parser);
void AddStatus(CommandParser& parser);
void AddWatch(CommandParser& parser);
void AddStop(CommandParser& parser);
void AddList(CommandParser& parser);

// In the order of `gauntlet --help`.
inline constexpr void (*kCommands[])(CommandParser&) = {AddEvolve, AddRandom, AddEvaluate, AddResume,
                                                        AddShow,   AddReplay, AddSubmit,   AddMaster,
                                                        AddStatus, AddWatch,  AddStop,     AddList};

}  // namespace gauntlet::master
