// gauntlet evolve, gauntlet random: a search on a pool of workers.

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "master/cli/commands.h"
#include "master/cli/common_options.h"
#include "master/cli/run_campaign.h"
#include "master/search/search_table.h"

namespace gauntlet::master {
namespace {

// What was given on the command line for another search than this.
Status CheckSettings(const CommonOptions& options, const SearchInfo& search) {
  struct Setting {
    std::string text;
    std::string key;
  };
  std::vector<Setting> settings;
  if (!options.generations.empty())
    settings.push_back({"--generations " + options.generations, "search.generations"});
  if (!options.population.empty())
    settings.push_back({"--population " + options.population, "search.population"});
  for (const std::string& set : options.sets)
    settings.push_back({"--set " + set, set.substr(0, set.find('='))});
  for (const Setting& setting : settings) {
    if (!setting.key.starts_with("search.") || setting.key == "search.algorithm" ||
        Reads(search, setting.key))
      continue;
    std::string known;
    for (const Key& key : CommonKeys(BuiltInCatalogue())) {
      if (!key.path.starts_with("search.") || !Reads(search, key.path)) continue;
      known += (known.empty() ? "" : ", ") + key.path;
      if (key.path == "search.cases") known += " (random --cases N)";
    }
    return InvalidInput(fmt::format("{}: the search '{}' does not read {}; it reads {}", setting.text,
                                    search.name, setting.key, known));
  }
  return Ok{};
}

ExitCode RunSearch(CommandContext& context, const CommonOptions& options,
                   const std::vector<ExtraSet>& extra) {
  const Result<Experiment> experiment = LoadExperimentWith(options, extra);
  if (!experiment) return Fail(context, experiment.error());
  const SearchRow& search = RowOf(*experiment);
  if (search.given_cases) {
    return Fail(context, InvalidInput("search.algorithm = cases needs a list of cases: use 'evaluate'"));
  }
  if (Status meant = CheckSettings(options, search.info); !meant) return Fail(context, meant.error());
  const Result<int> workers = ParseWorkers(options.workers);
  if (!workers) return Fail(context, workers.error());
  const Result<std::string> directory = NewDirectory(options, *experiment);
  if (!directory) return Fail(context, directory.error());

  CampaignRun campaign;
  campaign.directory = *directory;
  campaign.announcement = Announcement(*experiment, *workers, *directory);
  campaign.workers = *workers;
  campaign.run = [&](const SessionOptions& session) {
    return context.service.start(*directory, *experiment, {}, session);
  };
  campaign.report = [&](const SessionReport& report) -> Status {
    PrintSummary(context, report.summary, *directory, options.json);
    return Ok{};
  };
  return RunCampaign(context, options, campaign);
}

}  // namespace

ExitCode RunEvolve(CommandContext& context, const CommonOptions& options) {
  return RunSearch(context, options, {});
}

ExitCode RunRandom(CommandContext& context, const RandomOptions& options) {
  std::vector<ExtraSet> extra = {{"random", "search.algorithm=random"}};
  if (!options.cases.empty()) extra.push_back({"--cases", "search.cases=" + options.cases});
  return RunSearch(context, options.common, extra);
}

}  // namespace gauntlet::master
