// A study is run and told, by the workers of this machine or by a cluster's.
#pragma once

#include <string>

#include "cli/command_line.h"
#include "cli/options/options.h"
#include "slurm/slurm_campaign.h"
#include "study/study.h"

namespace gauntlet {

struct StudyRun {
  std::string directory;
  RunningOptions running;
  std::string markdown;                             // a file for the whole report; "" = none
  const slurm::SlurmCampaign* submitted = nullptr;  // the study's, whose workers are jobs
  std::string batch_job;                            // that holds this process, as its master; "" = none
};

// Goes on with the study in its directory, and prints what came out. Exit codes as RunCampaign's.
Result<ExitCode> RunStudyIn(CommandContext& context, const Study& study, const StudyRun& run);

// Hands the master's job of a submitted study to its cluster and says how to follow it.
Result<ExitCode> SubmitStudyJob(CommandContext& context, const std::string& directory,
                                const slurm::SlurmCampaign& campaign, bool json);

// What commands that start a study have in common.
struct StudyStartOptions {
  std::string directory;
  std::string markdown;
  bool dry_run = false;
  bool submit = false;
  std::vector<std::string> plugins;  // libraries
  SlurmOptions slurm;
  RunningOptions running;
};
void AddStudyStartOptions(CLI::App& command, StudyStartOptions& options);

// Begins the study in its directory, or goes on with it there.
Result<ExitCode> StartStudy(CommandContext& context, const Study& study, const StudyStartOptions& options);

}  // namespace gauntlet
