// Campaigns that run in a cluster, for the commands that meet one.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cli/command_line.h"
#include "cli/options/options.h"
#include "search/experiment/experiment.h"
#include "slurm/slurm_campaign.h"

namespace gauntlet {

// The user's file, then the [slurm] table of `file`, then the options; with a tag, drawn for `name`. Error:
// also an address on which nobody could listen.
Result<slurm::SlurmSettings> ReadSlurmOptions(const SlurmOptions& options,
                                              const std::optional<slurm::SlurmSource>& file,
                                              const std::string& name);

// Of a command that uses several cores, each run takes as many of its allocation's slots.
Status AskForCores(const Experiment& experiment, slurm::SlurmSettings& settings);

// What speaks to the campaign's cluster.
std::unique_ptr<slurm::SlurmClient> ClientOf(const CommandContext& context,
                                             const slurm::SlurmCampaign& campaign);

// The session's workers are the campaign's jobs. `campaign` outlives the session.
void UseJobs(const CommandContext& context, const slurm::SlurmCampaign& campaign, SessionOptions& session);

// Asks the cluster of the campaign's jobs whether they could ever start; `print` scripts and answers too.
// Error: the first that could not.
Status TestJobs(CommandContext& context, const slurm::SlurmCampaign& campaign, bool print);

// A master in this process with a pool of allocations. `batch_job`: the job that holds it, "" for none.
Result<ExitCode> ServeSubmitted(CommandContext& context, const ServingOptions& options,
                                const std::string& directory, const slurm::SlurmCampaign& campaign,
                                const std::string& batch_job);

// Hands the master's job of an existing campaign to its cluster. Error: with what to do next.
Result<std::string> SubmitMasterJob(CommandContext& context, const std::string& directory,
                                    const slurm::SlurmCampaign& campaign);

}  // namespace gauntlet
