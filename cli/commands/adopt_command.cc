// gauntlet adopt: somebody's ARGoS project, as it is, becomes an experiment.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/temporary_folder.h"
#include "cli/adopt/adopted_experiment.h"
#include "cli/adopt/project_folder.h"
#include "cli/adopt/score_candidates.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "cli/output/standard_output.h"
#include "controllers/command/placeholders.h"
#include "search/experiment/command_table.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostArgosFile = std::size_t{16} << 20;  // bytes of an .argos file
constexpr const char* kPlugins = "plugins";                    // in the folder of what is ours
constexpr const char* kLibraries = "lib";
constexpr const char* kCaseFile = "case.argos";
constexpr std::size_t kShownScores = 8;

struct AdoptOptions {
  std::string argos_file;
  std::string output;
  std::string length;
  std::string height;
  std::string record;
  std::string score;
  bool check = false;
  bool json = false;
  bool quiet = false;
};

// Everything that is learnt of the project on the way.
class Adoption {
 public:
  Adoption(CommandContext& context, const AdoptOptions& options) : context_(context), options_(options) {}

  Result<ExitCode> Run() {
    TRY(Judge());
    TRY(const std::string text, ReadSmallFile(options_.argos_file, kMostArgosFile));
    TRY(project_.form, MakeArgosTemplate(text, options_.argos_file, form_options_));
    TRY(const ArgosInstallation argos, FindArgos());
    TRY(folder_, FindProjectFolder(options_.argos_file, project_.form.libraries));
    Say(fmt::format("the project's folder is {}; compiling the recorder against {}", Printable(folder_),
                    Printable(argos.prefix)));
    TRY(MakeOwnFolder());
    TRY(CompileRecorder(argos, OwnPath(kPlugins) + "/gauntlet_recorder.so", context_.err));
    TRY(RunFirst(argos));
    TRY(RunAsPlanned());
    TRY(ChooseScore());
    TRY(const std::string experiment, ExperimentText());
    if (!options_.check) {
      TRY(Keep(experiment));
    }
    return Tell();
  }

 private:
  void Say(const std::string& message) {
    if (!options_.quiet) PrintMessage(context_, message);
  }
  std::string OwnPath(const std::string& name) const { return own_.path() + "/" + project_.own + "/" + name; }

  static Result<double> Seconds(const char* option, const std::string& text, double least) {
    const auto number = ParseNumber<double>(text);
    if (number && *number >= least && *number <= 1e6) return *number;
    return InvalidInput(
        fmt::format("{} {}: expected a number from {} to 1000000", option, Printable(text), least));
  }

  Status Judge() {
    if (options_.output.empty() && !options_.check)
      return InvalidInput("where to? say -o NAME.toml, or --check to write nothing");
    const fs::path output = options_.output.empty() ? fs::path("adopted.toml") : fs::path(options_.output);
    if (output.extension() != ".toml")
      return InvalidInput(
          fmt::format("-o {}: an experiment's file ends in .toml", Printable(options_.output)));
    project_.name = output.stem();
    project_.own = project_.name + ".adopted";
    project_.argos_file = options_.argos_file;
    std::error_code failed;
    const fs::path beside = fs::absolute(output).parent_path() / project_.own;
    for (const fs::path& taken : {beside, fs::absolute(output)}) {
      if (!options_.check && fs::exists(taken, failed))
        return InvalidInput(fmt::format("{} is there already: give another name, or remove it first",
                                        Printable(taken.string())));
    }
    if (!options_.length.empty()) {
      TRY(form_options_.length, Seconds("--length", options_.length, 0.1));
    }
    if (!options_.height.empty()) {
      TRY(form_options_.height, Seconds("--height", options_.height, 0.001));
    }
    if (!options_.record.empty()) {
      TRY(form_options_.every, Seconds("--record", options_.record, 0.0));
    }
    return Ok{};
  }

  Status MakeOwnFolder() {
    std::error_code failed;
    if (own_.path().empty()) return Error{ErrorKind::kIo, "no folder can be made in $TMPDIR or /tmp"};
    for (const char* name : {kPlugins, kLibraries}) fs::create_directories(OwnPath(name), failed);
    if (failed) return Error{ErrorKind::kIo, fmt::format("{}: {}", OwnPath(""), failed.message())};
    // ARGoS loads what is in these folders, wherever they are.
    const char* const path = std::getenv("ARGOS_PLUGIN_PATH");
    plugin_path_ = path == nullptr ? "" : path;
    for (char** entry = environ; *entry != nullptr; ++entry) {
      const std::string variable = *entry;
      const std::string name = variable.substr(0, variable.find('='));
      if (name == "PATH" || name == "LD_LIBRARY_PATH" ||
          (name.starts_with("ARGOS_") && name != "ARGOS_PLUGIN_PATH"))
        project_.environment.push_back(variable);
    }
    return Ok{};
  }

  // The run's file: the template with these obstacles.
  Status WriteCase(const std::string& folder, std::uint64_t seed, const sim::Genome& obstacles) {
    sim::RunSpec spec;
    spec.seed = seed;
    spec.test_case.obstacles = obstacles;
    controllers::command::Definition definition;
    for (const ArgosParameter& parameter : project_.form.parameters) {
      definition.parameters.push_back({.name = parameter.name, .default_value = parameter.value});
      spec.controller_parameters[parameter.name] = parameter.value;
    }
    const std::string filled = controllers::command::FillTemplate(definition, project_.form.text, spec);
    return ReplaceFile(folder + "/" + kCaseFile, WithWorld(filled, kWorldFile), kReadableByAll);
  }

  // In a copy of the project, to see what a run writes and loads.
  Status RunFirst(const ArgosInstallation& argos) {
    const TemporaryFolder copy("adopt");
    TRY(CopyProject(folder_, copy.path()));
    TRY(WriteCase(copy.path(), 1, {}));
    const auto before = FilesIn(copy.path());
    Say(fmt::format("running {} for {} simulated seconds, in a copy of the project",
                    Printable(options_.argos_file), NumberText(project_.form.length)));
    const std::string command = fmt::format(
        "env ARGOS_PLUGIN_PATH={} argos3 -n -c {}",
        ShellQuoted(OwnPath(kPlugins) + (plugin_path_.empty() ? "" : ":" + plugin_path_)), kCaseFile);
    TRY(const TrialRun run, RunTrial(copy.path(), command, context_.err));
    if (std::ranges::none_of(run.bodies, &ArenaBody::robot))
      return InvalidInput(
          fmt::format("{}: no robot has a controller when the experiment begins, so there is nothing "
                      "to test",
                      Printable(options_.argos_file)));
    for (const auto& [name, stamp] : FilesIn(copy.path())) {
      const auto old = before.find(name);
      const bool ours = name.starts_with("gauntlet-") || name.starts_with(".gauntlet-");
      if (!ours && (old == before.end() || old->second != stamp)) plan_.written.push_back(name);
    }
    project_.seconds = run.seconds;
    plan_.project = folder_;
    plan_.own = project_.own;
    TRY(KeepLibraries(run, copy.path(), argos.prefix));
    return ReplaceFile(OwnPath("run.sh"), RunScript(plan_), kReadableByAll);
  }

  Status KeepLibraries(const TrialRun& run, const std::string& copy, const std::string& prefix) {
    std::set<std::string> taken;
    std::map<std::string, std::string> moved;  // that the file names by an absolute path
    for (const LoadedLibrary& library : run.libraries) {
      const auto below = [&](const std::string& folder) { return library.path.starts_with(folder + "/"); };
      const bool in_project = library.named.starts_with(copy + "/");
      if (!in_project &&
          (below(prefix) || below("/usr") || below("/lib") || below("/lib64") || below(own_.path())))
        continue;
      std::string name = fs::path(library.named).filename();
      while (!taken.insert(name).second) name.insert(0, "_");
      const bool plugin = IsInPluginPath(library.named);
      std::error_code failed;
      fs::copy_file(library.path, OwnPath(plugin ? kPlugins : kLibraries) + "/" + name, failed);
      if (failed)
        return Error{ErrorKind::kIo, fmt::format("{}: {}", Printable(library.path), failed.message())};
      if (in_project) plan_.libraries[fs::path(library.named).lexically_relative(copy)] = name;
      for (const std::string& named : project_.form.libraries)
        if (named.starts_with('/') && !plugin && (named == library.named || named + ".so" == library.named))
          moved[named] = project_.own + "/" + kLibraries + "/" + name;
      kept_.push_back(name);
    }
    if (moved.empty()) return Ok{};
    form_options_.moved_libraries = std::move(moved);
    TRY(const std::string text, ReadSmallFile(options_.argos_file, kMostArgosFile));
    TRY(project_.form, MakeArgosTemplate(text, options_.argos_file, form_options_));
    return Ok{};
  }

  bool IsInPluginPath(const std::string& library) const {
    const std::string folder = fs::path(library).parent_path();
    return (":" + plugin_path_ + ":").find(":" + folder + ":") != std::string::npos ||
           (":" + plugin_path_ + ":").find(":" + folder + "/:") != std::string::npos;
  }

  Result<TrialRun> RunOnce(const TemporaryFolder& folder, std::uint64_t seed, const sim::Genome& obstacles) {
    std::error_code failed;
    fs::copy(own_.path() + "/" + project_.own, folder.path() + "/" + project_.own,
             fs::copy_options::recursive, failed);
    TRY(WriteCase(folder.path(), seed, obstacles));
    return RunTrial(folder.path(), fmt::format("sh {}/run.sh {}", ShellQuoted(project_.own), kCaseFile),
                    context_.err);
  }

  // As runs of the experiment will be: twice the same, once with another seed, once with an obstacle.
  Status RunAsPlanned() {
    Say("running it four times as it will be run: twice the same, with another seed, with an obstacle");
    TRY(first_, RunOnce(folders_[0], 1, {}));
    TRY(const TrialRun again, RunOnce(folders_[1], 1, {}));
    TRY(other_seed_, RunOnce(folders_[2], 2, {}));
    reproducible_ = first_.trajectory == again.trajectory;
    for (const LoadedLibrary& library : first_.libraries)
      if (library.path.starts_with(folder_ + "/"))
        Unsupported("library " + library.path,
                    "is loaded by a path of its own (RPATH): rebuilding it changes the "
                    "experiment");
    SortBodies();
    return RunWithObstacle();
  }

  Status RunWithObstacle() {
    const std::optional<sim::ObstacleGene> obstacle = ObstacleInTheWay(project_, first_);
    if (!obstacle) {
      with_obstacle_ = first_;
      Unsupported("obstacles",
                  "none was tried: the robots go nowhere where one would touch nothing at the beginning");
      return Ok{};
    }
    const std::string box =
        fmt::format("a box of {} x {} m and a height of {} m at {}", obstacle->length, obstacle->width,
                    form_options_.height, PointText(obstacle->x, obstacle->y));
    Result<TrialRun> run = RunOnce(folders_[3], 1, {*obstacle});
    if (!run) return InvalidInput(fmt::format("with {}: {}", box, run.error().message));
    with_obstacle_ = *std::move(run);
    if (!reproducible_ || with_obstacle_.trajectory != first_.trajectory) return Ok{};
    return InvalidInput(
        fmt::format("boxes do nothing here: with {}, where robots passed, every robot went as it did "
                    "without. Robots that fly need higher ones (--height), and some physics engines "
                    "know none",
                    box));
  }

  void SortBodies() {
    project_.poses = first_.poses;
    project_.poses.insert(project_.poses.end(), other_seed_.poses.begin(), other_seed_.poses.end());
    std::map<std::string, Pose> others;
    for (const ArenaBody& body : other_seed_.bodies) others[body.id] = {body.x, body.y};
    std::size_t random = 0;
    std::map<std::string, std::size_t> movable;
    for (const ArenaBody& body : first_.bodies) {
      const auto other = others.find(body.id);
      const bool fixed = other != others.end() && other->second.x == body.x && other->second.y == body.y;
      if (body.robot) project_.robots.push_back(body);
      if (!fixed) {
        ++random;
      } else if (body.robot || body.movable) {
        project_.fixed.push_back(body);
      } else {
        project_.standing.push_back(body);
      }
      if (!body.robot && body.movable) ++movable[body.kind];
    }
    for (const auto& [kind, count] : movable)
      Unsupported(fmt::format("{} of the kind {}", Counted(count, "movable thing"), kind),
                  "kept free of obstacles where they begin, and not known to the rule that leaves a path");
    std::map<std::string, std::size_t> kinds;
    for (const ArenaBody& robot : project_.robots) ++kinds[robot.kind];
    for (const auto& [kind, count] : kinds)
      project_.form.taken_over.push_back(
          fmt::format("{} of the kind {}", Counted(count, "robot"), Printable(kind)));
    if (!project_.standing.empty())
      project_.form.taken_over.push_back(Counted(project_.standing.size(), "thing") +
                                         " that stands in the arena");
    if (random > 0)
      project_.form.taken_over.push_back(
          fmt::format("places that differ from seed to seed: {}", Counted(random, "robot or thing")));
  }

  void Unsupported(std::string element, std::string meaning) {
    project_.form.unsupported.push_back({std::move(element), std::move(meaning)});
  }

  Status ChooseScore() {
    candidates_ = FindScores(first_, other_seed_, with_obstacle_, plan_.written);
    std::string from = options_.score;
    if (from.empty()) from = candidates_.empty() ? "displacement" : candidates_.front().from;
    if (from.find(':') == std::string::npos) from = "trajectory:" + from;
    Result<ScoreCandidate> score = ScoreNamed(from, first_, other_seed_, with_obstacle_);
    if (!score) return InvalidInput(fmt::format("--score {}: {}", Printable(from), score.error().message));
    if (candidates_.empty()) candidates_.push_back(*score);
    project_.score = from;
    project_.scores = {score->first, score->other_seed};
    return Ok{};
  }

  // Error: it would be refused.
  Result<std::string> ExperimentText() {
    for (const std::string& path : project_.form.absolute)
      Unsupported("the path " + path, "is absolute: if runs write there, those at the same time share it");
    std::string text = AdoptedExperimentText(project_);
    TRY(ReplaceFile(OwnPath(kCaseFile), project_.form.text, kReadableByAll));
    TRY(ReadCommand({text, project_.name + ".toml"}, {}));
    return text;
  }

  Status Keep(const std::string& experiment) {
    const fs::path output = fs::absolute(options_.output);
    const fs::path beside = output.parent_path() / project_.own;
    std::error_code failed;
    fs::copy(own_.path() + "/" + project_.own, beside, fs::copy_options::recursive, failed);
    if (failed)
      return Error{ErrorKind::kIo, fmt::format("{}: {}", Printable(beside.string()), failed.message())};
    return WriteOutputFile(output, experiment);
  }

  Result<ExitCode> Tell() {
    if (options_.json) {
      context_.out << Document().dump(2) << "\n" << std::flush;
      return kExitDone;
    }
    const auto list = [&](const char* title, const std::vector<std::string>& lines) {
      if (lines.empty()) return;
      context_.out << title << "\n";
      for (const std::string& line : lines) context_.out << "  " << Printable(line) << "\n";
    };
    const auto remarks = [](const std::vector<ArgosRemark>& all) {
      std::vector<std::string> lines;
      for (const ArgosRemark& remark : all) lines.push_back(remark.element + ": " + remark.meaning);
      return lines;
    };
    list("Taken over", project_.form.taken_over);
    list("Different in runs", remarks(project_.form.differs));
    list("Not taken over", remarks(project_.form.unsupported));
    std::vector<std::string> scores;
    for (const ScoreCandidate& one : candidates_) {
      if (scores.size() < kShownScores)
        scores.push_back(fmt::format("{}: {} without obstacles, {} with another seed, {} with an obstacle",
                                     one.from, one.first, one.other_seed, one.with_obstacle));
    }
    list("Scores that were seen (--score)", scores);
    context_.out << fmt::format("Two runs with one seed {}.\n", reproducible_ ? "are equal" : "differ")
                 << fmt::format("The score is {}; a run takes {:.1f} s.\n", Printable(project_.score),
                                first_.seconds);
    if (!options_.check)
      context_.out << fmt::format("\n  gauntlet evolve {} --dir campaigns/{}\n", PastedPath(options_.output),
                                  PastedPath(project_.name));
    context_.out << std::flush;
    return kExitDone;
  }

  json Document() const {
    const auto remarks = [](const std::vector<ArgosRemark>& all) {
      json list = json::array();
      for (const ArgosRemark& remark : all)
        list.push_back({{"element", remark.element}, {"meaning", remark.meaning}});
      return list;
    };
    json scores = json::array();
    for (const ScoreCandidate& one : candidates_)
      scores.push_back({{"from", one.from},
                        {"values", {one.first, one.other_seed}},
                        {"with_obstacle", one.with_obstacle}});
    return {{"taken_over", project_.form.taken_over},
            {"differs", remarks(project_.form.differs)},
            {"unsupported", remarks(project_.form.unsupported)},
            {"scores", scores},
            {"score", project_.score},
            {"reproducible", reproducible_},
            {"libraries", kept_},
            {"seconds", first_.seconds},
            {"experiment", options_.check ? json(nullptr) : json(options_.output)}};
  }

  CommandContext& context_;
  const AdoptOptions& options_;
  ArgosTemplateOptions form_options_;
  AdoptedProject project_;
  std::string folder_;  // of the project
  std::string plugin_path_;
  const TemporaryFolder own_{"adopt"};
  const std::array<TemporaryFolder, 4> folders_ = {TemporaryFolder("adopt"), TemporaryFolder("adopt"),
                                                   TemporaryFolder("adopt"), TemporaryFolder("adopt")};
  RunFolderPlan plan_;
  std::vector<std::string> kept_;
  TrialRun first_;
  TrialRun other_seed_;
  TrialRun with_obstacle_;
  bool reproducible_ = false;
  std::vector<ScoreCandidate> candidates_;
};

Result<ExitCode> RunAdopt(CommandContext& context, const AdoptOptions& options) {
  return Adoption(context, options).Run();
}

}  // namespace

void AddAdopt(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("adopt", "make an experiment of an ARGoS project, which runs in ARGoS itself", RunAdopt);
  command.add_option("FILE.argos", options.argos_file, "the project's experiment, as argos3 runs it")
      ->required();
  AddValue(command, "-o,--output", "NAME.toml", options.output,
           "the experiment to write; what it needs is written beside it, into NAME.adopted");
  AddValue(command, "--length", "S", options.length, "how long a run is (default: as the file says)");
  AddValue(command, "--score", "WHERE", options.score,
           "log:PATTERN, csv:FILE:COLUMN or a measure of positions such as displacement (default: the first "
           "that is "
           "seen)");
  AddValue(command, "--height", "M", options.height, "height of obstacles (default: 0.5)");
  AddValue(command, "--record", "S", options.record,
           "time between recorded positions; 0 = each tick (default: 1)");
  command.add_flag("--check", options.check, "run the project and tell what was seen; write nothing");
  command.add_flag("--json", options.json, "print the result as one JSON document");
  command.add_flag("--quiet", options.quiet, "print no messages, except errors");
  command.footer(
      R"(Runs the project five times: once in a copy, to see what it writes and which libraries it loads, then as the
experiment will run it. Call it where you call argos3, with the same environment. Nothing is written into the project.
Exit 2 when the project does not run, or when a box in the robots' way changes nothing. docs/from-argos.md goes through
an example.

Examples:
  gauntlet adopt experiments/foraging.argos -o foraging.toml --length 300
  gauntlet adopt my.argos -o my.toml --score 'log:items: (\d+)'
  gauntlet adopt my.argos --check --json)");
}

}  // namespace gauntlet
