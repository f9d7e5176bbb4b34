// Campaigns that run in Slurm, for the commands that meet one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "master/cli/command_context.h"
#include "master/cli/common_options.h"
#include "slurm/slurm_campaign.h"

namespace gauntlet::master {

// The campaign in `directory` as it was submitted; nothing when it was not. Error: its slurm.toml does not
// read.
Result<std::optional<SlurmCampaign>> FindSubmitted(const std::string& directory);

// A master in this process with a pool of Slurm allocations. `batch_job`: the job that holds it, "" for none.
ExitCode ServeSubmitted(CommandContext& context, const CommonOptions& options, const std::string& directory,
                        const SlurmCampaign& campaign, const std::string& batch_job);

// Hands the master's job of an existing campaign to Slurm. Error: with what to do next.
Result<std::string> SubmitMasterJob(CommandContext& context, const std::string& directory,
                                    const SlurmCampaign& campaign);

// `gauntlet resume` of a submitted campaign: a master here or as a job, as it was submitted.
ExitCode ResumeSubmitted(CommandContext& context, const CommonOptions& options,
                         const SlurmCampaign& campaign);

// Cancels what Slurm still has of the campaign; the answer is what was cancelled.
Result<std::vector<std::string>> CancelJobs(CommandContext& context, const SlurmCampaign& campaign);

}  // namespace gauntlet::master
