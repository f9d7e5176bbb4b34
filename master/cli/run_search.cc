#include "master/cli/run_search.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "master/cli/run_campaign.h"
#include "master/search/search_table.h"

namespace gauntlet::master {
namespace {

// What was given on the command line for another search than this.
Status CheckSettings(const SearchOptions& options, const SearchInfo& search) {
  struct Setting {
    std::string text;
    std::string key;
  };
  std::vector<Setting> settings;
  for (const ExtraSet& size : SetsOf(options.size))
    settings.push_back({fmt::format("{} {}", size.option, size.value), size.key});
  for (const std::string& set : options.experiment.sets)
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

}  // namespace

ExitCode RunSearch(CommandContext& context, const SearchOptions& options,
                   const std::vector<ExtraSet>& extra) {
  std::vector<ExtraSet> all = SetsOf(options.size);
  all.insert(all.end(), extra.begin(), extra.end());
  const Result<Experiment> experiment = LoadExperimentWith(options.experiment, all);
  if (!experiment) return Fail(context, experiment.error());
  const SearchRow& search = RowOf(*experiment);
  if (search.given_cases) {
    return Fail(context, InvalidInput("search.algorithm = cases needs a list of cases: use 'evaluate'"));
  }
  if (Status meant = CheckSettings(options, search.info); !meant) return Fail(context, meant.error());
  const Result<int> workers = ParseWorkers(options.running.workers);
  if (!workers) return Fail(context, workers.error());
  const Result<std::string> directory = NewDirectory(options.experiment.directory, *experiment);
  if (!directory) return Fail(context, directory.error());

  CampaignRun campaign;
  campaign.directory = *directory;
  campaign.announcement = Announcement(*experiment, *workers, *directory);
  campaign.workers = *workers;
  campaign.serving = options.running;
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Start(*directory, *experiment, {}, session);
  };
  return RunCampaign(context, campaign);
}

}  // namespace gauntlet::master
