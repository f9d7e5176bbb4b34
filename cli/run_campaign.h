// What evolve, random, evaluate and resume have in common: progress, clean stop, the closing messages.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/options/options.h"
#include "slurm/slurm_campaign.h"

namespace gauntlet {

struct CampaignRun {
  std::string directory;
  std::string resumed_by = "";        // the directory that `resume` takes, when it is not `directory`
  std::string goes_on_by = "";        // the command that goes on, with its arguments, when it is not `resume`
  bool same_command_resumes = false;  // it answers a question, which `resume` knows nothing of
  std::string announcement;           // one line before it begins, without "gauntlet: "; "" = none
  ServingOptions serving;
  BindOptions bind;
  bool looks_at_empty_arena = false;         // too, when it has ended
  std::optional<slurm::SlurmCampaign> jobs;  // whose jobs the workers are; none: session.workers says
  SessionOptions session;                    // workers and batch job; the rest follows from what stands above
  std::function<Result<SessionReport>(const SessionOptions&)> run;
  // Prints the result to context.out; nothing: the summary.
  std::function<Status(const SessionReport&)> report;

  // At one time, at most.
  int MostWorkers() const;
  // "4 workers", "workers from slurm"
  std::string WorkersText() const;
};

// What --workers and --slurm say. Error: they contradict each other, or one of them is wrong in itself.
Status CheckWorkers(const RunningOptions& options);

// Where settings of jobs come from, beside --slurm and the user's own file.
struct JobsSource {
  std::string experiment_file = "";  // its [slurm] table; "" = none
  std::string parent = "";           // a campaign that this one belongs to, which comes before the table
  bool anew = false;                 // what the campaign's directory says of jobs is of one that is replaced
};

// Workers of this machine, or jobs as --slurm says, beginning with what an earlier call has left in the
// campaign's directory; without --slurm and --workers as that call had them. Error: also a cluster on which
// no such job could start.
Status UseWorkers(CommandContext& context, const RunningOptions& options, const Experiment& experiment,
                  const JobsSource& source, CampaignRun& campaign);

// Runs it with progress on context.err; SIGINT and SIGTERM stop it cleanly. Exit 0; 1 when a search ended and
// none of its runs gave a result, or an audit found runs that end differently when they are repeated; 3 when
// it was stopped and can be resumed; or as the error demands.
Result<ExitCode> RunCampaign(CommandContext& context, const CampaignRun& campaign);

// To stderr: that what follows is a snapshot (CampaignView::as_of). Nothing when `as_of` is empty.
void PrintAsOf(CommandContext& context, const std::string& directory, const std::string& as_of);
// The summary as text or JSON.
Status PrintSummary(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                    bool json);
// The same of a campaign that had ended before; says that nothing was left to do.
Status PrintFinished(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                     const MessageOptions& options);

// A new campaign with workers of its own, but for what it is to run.
Result<CampaignRun> LocalRun(CommandContext& context, const std::vector<SearchPlan>& searches,
                             const LocalOptions& options);
// Runs it (or is a dry run), and when it has come to its end tells what it has found.
Result<ExitCode> RunAndTell(CommandContext& context, const std::vector<SearchPlan>& searches,
                            const LocalOptions& options,
                            const std::function<Result<ExitCode>(const std::string& directory)>& tell);

// The cases that --on chooses and that the swarm can be put into; how many were left out is said.
Result<std::vector<sim::TestCase>> GivenCases(CommandContext& context, const std::string& on,
                                              const Experiment& experiment, bool quiet);

}  // namespace gauntlet
