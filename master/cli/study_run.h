// A study is run and told.
#pragma once

#include <string>

#include "master/cli/command_line.h"
#include "master/cli/options.h"
#include "master/study/study.h"

namespace gauntlet::master {

struct StudyRun {
  std::string directory;
  RunningOptions running;
  std::string markdown;  // a file for the whole report; "" = none
};

// Begins the study in its directory or goes on with it there, and prints what came out. Exit codes as
// RunCampaign's.
ExitCode RunStudyIn(CommandContext& context, const Study& study, const StudyRun& run);
// The same in `run.directory`, "" for a default one, which is made when it is not there; with `dry_run` says
// what that would cost instead.
ExitCode StartStudy(CommandContext& context, const Study& study, StudyRun run, bool dry_run);

}  // namespace gauntlet::master
