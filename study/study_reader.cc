#include "study/study.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/system/atomic_file.h"
#include "master/directory/commands.h"
#include "master/directory/plugins.h"
#include "search/experiment/experiment_file.h"
#include "search/experiment/seed_list.h"
#include "search/search_setup.h"
#include "search/search_table.h"
#include "study/sets/csv_column.h"
#include "study/sets/subset.h"
#include "study/study_file.h"
#include "study/tuning.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using ReadText = std::function<Result<std::string>(const std::string& file)>;

constexpr std::size_t kMostSearches = 1000;

class Reader {
 public:
  // Whose libraries its experiments may take: those that were given, or also those that their files name.
  enum class Libraries { kGiven, kGivenAndNamed };

  Reader(ReadText read, TuningChanges changes, std::vector<std::string> plugins, Libraries libraries)
      : read_(std::move(read)), libraries_(libraries) {
    study_.changes = std::move(changes);
    study_.plugins = std::move(plugins);
    catalogue_.plugins = study_.plugins;
  }

  Result<Study> Read(const std::string& main_file) {
    Result<Study> study = ReadFrom(main_file);
    if (!study) return Printable(study.error());
    return study;
  }

 private:
  Result<Study> ReadFrom(const std::string& main_file) {
    study_.main_file = main_file;
    TRY(ReadFile(main_file, /*main=*/true));
    if (study_.name.empty()) return InvalidInput(main_file + ": the study has no name");
    if (!IsName(study_.name)) {
      return InvalidInput(
          fmt::format("{}: name = \"{}\" is no good folder name: use up to {} letters, digits, '.', '_' "
                      "or '-', and begin with none of '.' and '-'",
                      main_file, study_.name, kMostNameBytes));
    }
    if (study_.parts.empty()) return InvalidInput(main_file + ": the study has no parts");
    TRY(CheckAnalyses());
    std::erase_if(study_.plugins, [this](const std::string& hash) {
      return std::ranges::none_of(study_.parts, [&](const StudyPart& part) {
        return part.experiment.plugin == hash || part.experiment.scenario_plugin == hash;
      });
    });
    for (const StudyAnalysis& tuning : study_.analyses) {
      if (!tuning.tuning || (study_.changes.experiment.empty() && study_.changes.tries.empty())) continue;
      const bool is_of_another = tuning.tuning->experiment != tuning.Key("experiment");
      const std::string& experiment = study_.parts.front().experiment.name;
      if (is_of_another) study_.name = "tune-" + experiment;
      if (is_of_another || study_.description.empty() || !study_.changes.tries.empty())
        study_.description = "which values of the search's parameters find tougher cases for " + experiment;
    }
    return std::move(study_);
  }

  Status ReadFile(const std::string& file, bool main) {
    if (study_.texts.contains(file)) return InvalidInput(fmt::format("{} is included twice", file));
    TRY(auto text, read_(file));
    study_.texts[file] = text;
    TRY(auto content, ReadStudyFile(text, file));
    if (main) {
      study_.name = content.top["name"];
      study_.description = content.top["description"];
    }
    for (const std::string& name : ListItems(content.top["include"])) {
      TRY(ReadFile(name + ".toml", /*main=*/false));
    }
    std::map<std::string, PublishedNote> notes;
    for (const StudyFileTable& table : content.tables) {
      if (table.kind == "note") {
        notes[table.name] = {table.Key("text"), table.Key("always") == "true"};
      } else {
        TRY(table.kind == "part" ? AddPart(table) : AddAnalysis(table));
      }
    }
    const TuningChanges repeats_alone{.repeats = study_.changes.repeats};
    if (study_.changes != repeats_alone) return Ok{};
    for (const std::string& published : ListItems(content.top["published"])) {
      TRY(AddPublished(published, notes));
    }
    return Ok{};
  }

  const StudyPart* FindPart(const std::string& name) const { return FindByName(study_.parts, name); }

  Status AddPart(const StudyFileTable& table) {
    if (FindPart(table.name) != nullptr) {
      return InvalidInput(fmt::format("{}: there is a part '{}' already", table.where, table.name));
    }
    const std::string kind = table.Key("kind");
    StudyPart part;
    part.name = table.name;
    part.where = table.where;
    part.group = table.Key("group");
    part.kind = kind == "evolve"   ? StudyPart::Kind::kEvolve
                : kind == "random" ? StudyPart::Kind::kRandom
                : kind == "empty"  ? StudyPart::Kind::kEmpty
                                   : StudyPart::Kind::kEvaluate;
    const bool evaluates = part.kind == StudyPart::Kind::kEvaluate;
    for (const auto& [key, wanted] : {std::pair<std::string, bool>{"from", evaluates},
                                      {"cases", part.kind == StudyPart::Kind::kRandom}}) {
      if (table.Has(key) == wanted) continue;
      return InvalidInput(fmt::format("{}: a part of the kind {} {} the key {}", table.PlaceOf(key), kind,
                                      wanted ? "needs" : "does not take", key));
    }
    const std::string seeds = table.Has("seeds") ? table.Key("seeds") : "1";
    const auto numbers = ParseSeedList(seeds, kMostSearches);
    if (!numbers) {
      return InvalidInput(fmt::format("{}: seeds are '{}', expected a range (1..20) or a list (1,5,9)",
                                      table.PlaceOf("seeds"), seeds));
    }
    if (numbers->size() > 1 && evaluates) {
      return InvalidInput(
          fmt::format("{}: a part of the kind evaluate has one seed, from which those of its "
                      "searches follow",
                      table.PlaceOf("seeds")));
    }
    part.seeds = *numbers;
    if (evaluates) {
      TRY(SetSource(table, part));
    }
    TRY(SetExperiment(table, part));
    study_.parts.push_back(std::move(part));
    return Ok{};
  }

  // Parts stand behind those that they take cases from, so nothing can lead round in a circle.
  Status SetSource(const StudyFileTable& table, StudyPart& part) {
    const std::string from = table.Key("from");
    const std::string where = table.PlaceOf("from");
    const bool whole = FindPart(from) != nullptr;  // a tuning's parts have names with colons and commas
    const std::vector<StudySet> sources = whole ? std::vector<StudySet>{{from, ""}} : SplitStudySets(from);
    if (sources.size() != 1)
      return InvalidInput(fmt::format("{}: from is '{}', expected one PART[:SUBSET]", where, from));
    part.from = sources[0].part;
    part.subset = sources[0].subset;
    const StudyPart* source = FindPart(part.from);
    if (source == nullptr) {
      return InvalidInput(
          fmt::format("{}: {} above this one", where, UnknownName("part", part.from, study_.parts)));
    }
    if (source->kind == StudyPart::Kind::kEvaluate) {
      return InvalidInput(fmt::format("{}: '{}' simulates cases of '{}' itself; take them from there", where,
                                      part.from, source->from));
    }
    TRY(const auto subset, ParseSubset(part.subset, where));
    if (subset.search > 0) {
      return InvalidInput(
          fmt::format("{}: a part is taken as a whole, not search {} of it", where, subset.search));
    }
    return Ok{};
  }

  // An evaluation has the settings of the part that its cases come from, unless it names an experiment.
  Status SetExperiment(const StudyFileTable& table, StudyPart& part) {
    const bool inherits = !table.Has("experiment");
    std::string name = table.Key("experiment");
    std::vector<std::string> sets;
    if (inherits) {
      if (part.from.empty())
        return InvalidInput(fmt::format("{}: [part.{}] needs the key experiment", table.where, part.name));
      std::tie(name, sets) = sources_.at(part.from);
    } else {
      sets = study_.changes.sets;
    }
    std::ranges::move(table.Sets(), std::back_inserter(sets));
    sources_[part.name] = {name, sets};
    if (table.Has("replicates")) sets.push_back("search.replicates=" + table.Key("replicates"));
    if (part.kind == StudyPart::Kind::kRandom) {
      sets.emplace_back("search.algorithm=random");
      sets.push_back("search.cases=" + table.Key("cases"));
    }
    if (part.kind == StudyPart::Kind::kEmpty || part.kind == StudyPart::Kind::kEvaluate) {
      std::erase_if(sets, [](const std::string& set) {
        return set.starts_with("search.") && !set.starts_with("search.replicates");
      });
      sets.emplace_back("search.algorithm=cases");
    }
    TRY(AddLibrariesOf(name, sets));
    Result<Experiment> experiment = LoadExperiment(name, sets, catalogue_);
    if (!experiment) {
      return Error{experiment.error().kind,
                   fmt::format("{}: part '{}': {}", table.where, part.name, experiment.error().message)};
    }
    part.experiment = *std::move(experiment);
    const StudyPart* source = part.from.empty() ? nullptr : FindPart(part.from);
    if (source != nullptr && source->experiment.scenario != part.experiment.scenario) {
      return InvalidInput(fmt::format("{}: part '{}' has the scenario '{}', the cases of '{}' are of '{}'",
                                      table.where, part.name, part.experiment.scenario, part.from,
                                      source->experiment.scenario));
    }
    return Ok{};
  }

  // Makes known what the experiment's file asks for by its key plugins. What is wrong with the file itself is
  // said by who reads it next.
  Status AddLibrariesOf(const std::string& experiment, const std::vector<std::string>& sets) {
    const Result<ExperimentText> text = ReadExperimentText(experiment);
    if (!text) return Ok{};
    TRY(const std::optional<std::string> command, AddCommandOf(*text, sets, {}));
    catalogue_.command = command.value_or("");
    if (libraries_ == Libraries::kGiven) return Ok{};
    TRY(const std::vector<std::string> files, PluginFilesOf(*text));
    for (const std::string& file : files) {
      if (!named_libraries_.insert(file).second) continue;
      TRY(AddPluginFile(file, study_.plugins));
    }
    catalogue_.plugins = study_.plugins;
    return Ok{};
  }

  Status AddAnalysis(const StudyFileTable& table) {
    if (FindByName(study_.analyses, table.name) != nullptr) {
      return InvalidInput(fmt::format("{}: there is an analysis '{}' already", table.where, table.name));
    }
    StudyAnalysis& analysis = study_.analyses.emplace_back(StudyAnalysis{table, std::nullopt});
    if (analysis.kind != "tune") return Ok{};
    TRY(AddLibrariesOf(
        study_.changes.experiment.empty() ? table.Key("experiment") : study_.changes.experiment, {}));
    TRY(auto expanded, ExpandTuning(table, study_.changes, catalogue_));
    analysis.tuning = std::move(expanded.tuning);
    for (const StudyFileTable& part : expanded.parts) {
      TRY(AddPart(part));
    }
    return Ok{};
  }

  Status AddPublished(const std::string& file, const std::map<std::string, PublishedNote>& notes) {
    TRY(auto text, read_(file));
    study_.texts[file] = text;
    TRY(const auto rows, ReadCsvLines(text, file));
    const std::vector<std::string> header = {"section", "quantity", "condition", "value",
                                             "figure",  "rule",     "note"};
    if (rows.empty() || rows.front().cells != header) {
      return InvalidInput(fmt::format("{}:1: the columns have to be {}", file, fmt::join(header, ",")));
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const std::vector<std::string>& cells = rows[i].cells;
      PublishedRow row{cells[0], cells[1], cells[2], cells[3], cells[4], cells[5], {}};
      if (!cells[6].empty()) {
        const auto note = notes.find(cells[6]);
        if (note == notes.end()) {
          return InvalidInput(fmt::format("{}: row {} has the note '{}', but there is no [note.{}]", file, i,
                                          cells[6], cells[6]));
        }
        row.note = note->second;
      }
      study_.published.push_back(std::move(row));
    }
    return Ok{};
  }

  // The parts that analyses name exist, and so do the subsets.
  Status CheckAnalyses() const {
    for (const StudyAnalysis& analysis : study_.analyses) {
      for (const char* key : {"first", "second", "part"}) {
        for (const StudySet& set : SplitStudySets(analysis.Key(key))) {
          if (FindPart(set.part) == nullptr) {
            return InvalidInput(
                fmt::format("{}: {}: {}", analysis.where, key, UnknownName("part", set.part, study_.parts)));
          }
          TRY(ParseSubset(set.subset, fmt::format("{}: {}", analysis.where, key)));
          if (!analysis.Has("metric")) continue;
          const Status known = CheckMetric(FindPart(set.part)->experiment, analysis.Key("metric"));
          if (!known) return InvalidInput(fmt::format("{}: {}", analysis.where, known.error().message));
        }
      }
    }
    for (const PublishedRow& row : study_.published) {
      const std::string name = row.figure.substr(0, row.figure.find('.'));
      if (name.empty() || FindByName(study_.analyses, name) != nullptr) continue;
      return InvalidInput(fmt::format("published figure '{}' ({}): {}", row.figure, row.section,
                                      UnknownName("analysis", name, study_.analyses)));
    }
    return Ok{};
  }

  ReadText read_;
  Study study_;
  Libraries libraries_;
  std::set<std::string> named_libraries_;  // files that are known
  Catalogue catalogue_ = BuiltInCatalogue();
  std::map<std::string, std::pair<std::string, std::vector<std::string>>> sources_;  // by part
};

Result<fs::path> PathOf(const std::string& name_or_path) {
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml"))
    return fs::path(name_or_path);
  const std::map<std::string, fs::path> shipped = ShippedFiles("studies");
  if (const auto found = shipped.find(name_or_path); found != shipped.end()) return found->second;
  const std::string wrong =
      shipped.empty()
          ? fmt::format("there is no study '{}': no studies are installed beside this program", name_or_path)
          : fmt::format("{} (a file is named by a path ending in .toml)",
                        UnknownName("study", name_or_path, ShippedStudies()));
  return Error{ErrorKind::kNotFound, wrong};
}

}  // namespace

std::vector<StudySet> SplitStudySets(const std::string& text) {
  std::vector<StudySet> sets;
  for (const std::string& one : ListItems(text)) {
    const std::size_t colon = one.find(':');
    sets.push_back({one.substr(0, colon), colon == std::string::npos ? "" : one.substr(colon + 1)});
  }
  return sets;
}

std::vector<std::string> ShippedStudies() {
  std::vector<std::string> names;
  for (const auto& [name, path] : ShippedFiles("studies")) names.push_back(name);
  return names;
}

Result<Study> LoadStudy(const std::string& name_or_path, const TuningChanges& changes,
                        const std::vector<std::string>& plugins) {
  TRY(const auto path, PathOf(name_or_path));
  const auto read = [&](const std::string& file) -> Result<std::string> {
    Result<std::string> text = ReadSmallFile((path.parent_path() / file).string());
    if (text || text.error().kind != ErrorKind::kNotFound) return text;
    return Error{ErrorKind::kNotFound,
                 fmt::format("there is no study file '{}'", (path.parent_path() / file).string())};
  };
  return Reader(read, changes, plugins, Reader::Libraries::kGivenAndNamed).Read(path.filename().string());
}

Result<Study> ReadStudy(const std::map<std::string, std::string>& texts, const std::string& main_file,
                        const TuningChanges& changes, const std::vector<std::string>& plugins) {
  const auto read = [&](const std::string& file) -> Result<std::string> {
    const auto found = texts.find(file);
    if (found != texts.end()) return found->second;
    return Error{ErrorKind::kCorrupt, fmt::format("the study's file '{}' is missing", file)};
  };
  return Reader(read, changes, plugins, Reader::Libraries::kGiven).Read(main_file);
}

}  // namespace gauntlet
