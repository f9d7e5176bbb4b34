#include "cli/argos_files.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/system/atomic_file.h"
#include "cli/output/output_file.h"
#include "controllers/command/placeholders.h"
#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "master/directory/commands.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "search/cases/argos_controllers.h"
#include "search/cases/argos_export.h"
#include "search/cases/argos_template.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostControllerBytes = 16U << 20;  // of a controller file

constexpr std::string_view kLinkRange = "link_range";  // a parameter of ours, which no .argos file has

struct NamedRun {
  std::string file;
  RunId run = 0;
};

Result<std::optional<ArgosControllers>> ControllersOf(const ArgosFilesOptions& options) {
  std::optional<ArgosControllers> controllers;
  if (options.controller_file.empty()) return controllers;
  const Result<std::string> text = ReadSmallFile(options.controller_file, kMostControllerBytes);
  if (!text) return InvalidInput(fmt::format("--controller-file {}", text.error().message));
  TRY(controllers, ReadArgosControllers(*text, options.controller_file, options.controller));
  return controllers;
}

// The first run of each test case, in which it was found.
Result<std::vector<NamedRun>> FirstRuns(const StoredCampaign& campaign) {
  std::vector<NamedRun> runs;
  for (SearchId search = 1; search <= campaign.plans.size(); ++search) {
    std::map<IndividualId, RunId> first;
    TRY(campaign.view.store->ForEachRow(search, 0, [&](const StoredRun& run) {
      first.try_emplace(run.individual, run.id);
      return Ok{};
    }));
    const std::string of_search = campaign.plans.size() > 1 ? fmt::format("search-{}-", search) : "";
    // As many digits for all, so that files sort by number.
    const std::size_t digits = first.empty() ? 1 : fmt::formatted_size("{}", first.rbegin()->first);
    for (const auto& [individual, run] : first)
      runs.push_back({fmt::format("{}case-{:0{}}.argos", of_search, individual, digits), run});
  }
  return runs;
}

// A notice when the file's controller seems to be another than the run's; "" when not.
std::string Unlikeness(const ArgosControllers& own, const sim::RunSpec& spec) {
  std::vector<std::string> parameters;
  for (const auto& [name, value] : spec.controller_parameters)
    if (name != kLinkRange) parameters.push_back(name);
  const std::string unlike = UnlikenessTo(own, spec.controller, parameters);
  if (unlike.empty()) return "";
  return fmt::format("The controller '{}' of --controller-file may not be the '{}' that was simulated: {}.",
                     own.id, spec.controller, unlike);
}

// The very file that a run of an ARGoS project had.
Result<ArgosFile> FileOfCommand(RunId id, const sim::RunSpec& spec) {
  TRY(const controllers::command::Definition definition, CommandOf(spec.scenario_plugin));
  const auto form =
      std::ranges::find(definition.files, definition.case_template, &controllers::command::File::name);
  if (!definition.case_template.ends_with(".argos") || form == definition.files.end())
    return InvalidInput(
        fmt::format("run {} is one of a program that is given no .argos file", proto::RunText(id)));
  const auto folder =
      std::filesystem::path(controllers::FindPlugin(spec.scenario_plugin)->file).parent_path();
  TRY(const std::string text, ReadSmallFile(folder / kCommandFiles / form->hash, kMostControllerBytes));
  return ArgosFile{WithoutRecorder(controllers::command::FillTemplate(definition, text, spec)), {}};
}

Result<ArgosFile> FileOf(const StoredCampaign& campaign, RunId id,
                         const std::optional<ArgosControllers>& controllers) {
  TRY(const std::optional<StoredRun> stored, campaign.view.store->LoadRun(id));
  if (!stored.has_value())
    return Error{ErrorKind::kNotFound,
                 fmt::format("there is no run {} in this campaign", proto::RunText(id))};
  TRY(const sim::RunSpec spec, proto::DecodeRunSpec(stored->spec));
  if (spec.scenario == controllers::command::kScenario) return FileOfCommand(id, spec);
  const Result<sim::RunStart> start = controllers::StartOf(spec);
  if (!start)
    return Error{start.error().kind,
                 fmt::format("run {} cannot begin: {}", proto::RunText(id), start.error().message)};
  std::optional<ArgosControllers> own = controllers;
  const std::string unlike = own && !spec.plugin.empty() ? Unlikeness(*own, spec) : "";
  if (own && !spec.plugin.empty()) own = WithParameters(std::move(*own), spec.controller_parameters);
  const std::string title = fmt::format("Run {} of {}, test case {}, scenario {}, controller {}.", id,
                                        campaign.plans[stored->search - 1].experiment.name,
                                        stored->individual, spec.scenario, spec.controller);
  ArgosFile file = WriteArgos(spec, *start, own ? &*own : nullptr, title);
  if (!unlike.empty()) file.notices.push_back(unlike);
  return file;
}

}  // namespace

Result<ArgosFilesReport> WriteArgosFiles(const StoredCampaign& campaign, const ArgosFilesOptions& options,
                                         const std::filesystem::path& directory) {
  TRY(const std::optional<ArgosControllers> controllers, ControllersOf(options));
  std::vector<NamedRun> runs;
  for (const RunId run : options.runs) runs.push_back({fmt::format("run-{}.argos", run), run});
  if (runs.empty()) {
    TRY(runs, FirstRuns(campaign));
  }
  ArgosFilesReport report;
  for (const NamedRun& one : runs) {
    const Result<ArgosFile> file = FileOf(campaign, one.run, controllers);
    if (!file && options.runs.empty() && file.error().kind == ErrorKind::kInvalidInput) {
      ++report.notices[fmt::format("There is no {}: {}.", one.file, file.error().message)];
      continue;
    }
    if (!file) return file.error();
    TRY(WriteOutputFile(directory / one.file, file->text));
    ++report.files;
    for (const std::string& notice : file->notices) ++report.notices[notice];
  }
  return report;
}

Result<std::string> ControllersWithParameters(const sim::RunSpec& spec, const ArgosFilesOptions& options) {
  if (spec.scenario != controllers::command::kScenario) {
    TRY(std::optional<ArgosControllers> own, ControllersOf(options));
    if (!own) return std::string();
    const std::string sections = WithParameters(std::move(*own), spec.controller_parameters).sections;
    return fmt::format("<controllers>\n{}\n</controllers>\n", sections);
  }
  const Result<ArgosFile> file = FileOfCommand(0, spec);
  if (!file) return std::string();  // a program that is given another file
  constexpr std::string_view kEnd = "</controllers>";
  const std::size_t begin = file->text.find("<controllers");
  const std::size_t end = file->text.find(kEnd, begin);
  if (begin == std::string::npos || end == std::string::npos) return std::string();
  return file->text.substr(begin, end + kEnd.size() - begin) + "\n";
}

}  // namespace gauntlet
