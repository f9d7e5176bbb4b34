// What evolve, random, evaluate and resume have in common: progress, clean stop, the closing messages.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "master/cli/command_context.h"
#include "master/cli/options.h"

namespace gauntlet::master {

struct CampaignRun {
  std::string directory;
  std::string announcement;  // one line before it begins, without "gauntlet: "; "" = none
  ServingOptions serving;
  BindOptions bind;
  int workers = 1;                                                                // on this machine
  std::string batch_job;                                                          // SessionOptions::batch_job
  std::function<Result<std::unique_ptr<WorkerPool>>(const PoolSite&)> make_pool;  // nothing: the local pool
  std::function<Result<SessionReport>(const SessionOptions&)> run;
  // Prints the result to context.out; nothing: the summary.
  std::function<Status(const SessionReport&)> report;
};

// Runs it with progress on context.err; SIGINT and SIGTERM stop it cleanly. Exit 0; 1 when a search ended and
// none of its runs gave a result; 3 when it was stopped and can be resumed; or as the error demands.
ExitCode RunCampaign(CommandContext& context, const CampaignRun& campaign);

// The summary as text or JSON.
void PrintSummary(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                  bool json);
// The same of a campaign that had ended before; says that nothing was left to do.
void PrintFinished(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                   const MessageOptions& options);

// "flocking: genetic search, 20 test cases x 50 generations, seed 1, 2 workers, in DIR".
std::string Announcement(const Experiment& experiment, int workers, const std::string& directory);

}  // namespace gauntlet::master
