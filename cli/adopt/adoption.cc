#include "cli/adopt/adoption.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/temporary_folder.h"
#include "cli/adopt/adopted_experiment.h"
#include "cli/adopt/argos_installation.h"
#include "cli/adopt/project_folder.h"
#include "cli/adopt/trial_run.h"
#include "cli/output/output_file.h"
#include "controllers/command/placeholders.h"
#include "search/experiment/command_table.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostArgosFile = std::size_t{16} << 20;  // bytes
constexpr const char* kPlugins = "plugins";                    // in the folder of what is ours
constexpr const char* kLibraries = "lib";
// Runs without obstacles of which the scores are taken, and of those that take longer.
constexpr int kScores = 10;
constexpr int kFewScores = 4;
constexpr double kShortRun = 10.0;  // s
// Places where robots begin that our engine and ARGoS are compared from, each without and with an obstacle.
constexpr std::size_t kComparedStarts = 5;
constexpr const char* kCaseFile = "case.argos";

// Without a path, files would be written where we are: in the project.
Status CheckMade(const TemporaryFolder& folder) {
  if (!folder.path().empty()) return Ok{};
  return Error{ErrorKind::kIo, "no folder can be made in $TMPDIR or /tmp"};
}

// Everything that is learnt of the project on the way.
class Adoption {
 public:
  Adoption(const AdoptionOptions& options, const std::function<void(const std::string&)>& say,
           std::ostream& said)
      : options_(options), say_(say), said_(said), form_options_(options.form) {}

  Result<Adopted> Run() {
    TRY(Judge());
    TRY(MakeTemplate());
    TRY(const ArgosInstallation argos, FindArgos());
    TRY(folder_, FindProjectFolder(options_.argos_file, project_.form.libraries, project_.form.paths));
    TRY(NameLibrariesOutside());
    say_(fmt::format("the project's folder is {}; compiling the recorder against {}", Printable(folder_),
                     Printable(argos.prefix)));
    TRY(MakeOwnFolder());
    TRY(CompileRecorder(argos, OwnPath(kPlugins) + "/gauntlet_recorder.so", said_));
    TRY(RunFirst(argos));
    TRY(RunAsPlanned());
    TRY(ChooseScore());
    TRY(RunMore());
    CompareWithOurs();
    TRY(Write());
    return Adopted{.taken_over = project_.form.taken_over,
                   .differs = project_.form.differs,
                   .unsupported = project_.form.unsupported,
                   .scores = candidates_,
                   .score = project_.score,
                   .libraries = kept_,
                   .reproducible = reproducible_,
                   .engine = engine_,
                   .seconds = first_.seconds};
  }

 private:
  std::string OwnPath(const std::string& name) const { return own_.path() + "/" + project_.own + "/" + name; }

  Status Judge() {
    const bool writes = !options_.experiment.empty();
    const fs::path output = fs::absolute(writes ? options_.experiment : "adopted.toml");
    if (output.extension() != ".toml")
      return InvalidInput(
          fmt::format("-o {}: an experiment's file ends in .toml", Printable(options_.experiment)));
    project_.name = output.stem();
    project_.own = project_.name + ".adopted";
    project_.argos_file = options_.argos_file;
    std::error_code failed;
    for (const fs::path& taken : {output.parent_path() / project_.own, output}) {
      if (writes && fs::exists(taken, failed))
        return InvalidInput(fmt::format("{} is there already: give another name, or remove it first",
                                        Printable(taken.string())));
    }
    return Ok{};
  }

  Status MakeTemplate() {
    TRY(const std::string text, ReadSmallFile(options_.argos_file, kMostArgosFile));
    TRY(project_.form, MakeArgosTemplate(text, options_.argos_file, form_options_));
    return Ok{};
  }

  // A run's folder has nothing above it: what lies above the project's, or anywhere, is named by its whole
  // path at first, and then by that of the copy that is kept.
  Status NameLibrariesOutside() {
    for (const std::string& library : project_.form.libraries) {
      if (library.starts_with("../") || library.starts_with('/'))
        form_options_.moved_libraries[library] = (fs::path(folder_) / library).lexically_normal();
    }
    return form_options_.moved_libraries.empty() ? Status(Ok{}) : MakeTemplate();
  }

  Status MakeOwnFolder() {
    std::error_code failed;
    TRY(CheckMade(own_));
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
    return WriteFilled(folder, project_.form, seed, obstacles);
  }

  static Status WriteFilled(const std::string& folder, const ArgosTemplate& form, std::uint64_t seed,
                            const sim::Genome& obstacles) {
    sim::RunSpec spec;
    spec.seed = seed;
    spec.test_case.obstacles = obstacles;
    controllers::command::Definition definition;
    for (const ArgosParameter& parameter : form.parameters) {
      definition.parameters.push_back({.name = parameter.name, .default_value = parameter.value});
      spec.controller_parameters[parameter.name] = parameter.value;
    }
    const std::string filled = controllers::command::FillTemplate(definition, form.text, spec);
    return ReplaceFile(folder + "/" + kCaseFile, WithWorld(filled, kWorldFile), kReadableByAll);
  }

  // In a copy of the project, to see what a run writes and loads.
  Status RunFirst(const ArgosInstallation& argos) {
    const TemporaryFolder copy("adopt");
    TRY(CheckMade(copy));
    TRY(CopyProject(folder_, copy.path()));
    TRY(WriteCase(copy.path(), 1, {}));
    const auto before = FilesIn(copy.path());
    say_(fmt::format("running {} for {} simulated seconds, in a copy of the project",
                     Printable(options_.argos_file), NumberText(project_.form.length)));
    const std::string command = fmt::format(
        "env ARGOS_PLUGIN_PATH={} argos3 -n -c {}",
        ShellQuoted(OwnPath(kPlugins) + (plugin_path_.empty() ? "" : ":" + plugin_path_)), kCaseFile);
    TRY(const TrialRun run, RunTrial(copy.path(), command, said_));
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
      for (auto& [named, path] : form_options_.moved_libraries)
        if (path == library.named || path + ".so" == library.named)
          path = project_.own + "/" + kLibraries + "/" + name;
      kept_.push_back(name);
    }
    return form_options_.moved_libraries.empty() ? Status(Ok{}) : MakeTemplate();
  }

  bool IsInPluginPath(const std::string& library) const {
    const std::string folder = fs::path(library).parent_path();
    return (":" + plugin_path_ + ":").find(":" + folder + ":") != std::string::npos ||
           (":" + plugin_path_ + ":").find(":" + folder + "/:") != std::string::npos;
  }

  Result<TrialRun> RunOnce(const TemporaryFolder& folder, std::uint64_t seed, const sim::Genome& obstacles) {
    TRY(CheckMade(folder));
    TRY(WriteCase(folder.path(), seed, obstacles));
    return RunCaseIn(folder);
  }

  Result<TrialRun> RunCaseIn(const TemporaryFolder& folder) {
    std::error_code failed;
    fs::copy(own_.path() + "/" + project_.own, folder.path() + "/" + project_.own,
             fs::copy_options::recursive, failed);
    return RunTrial(folder.path(), fmt::format("sh {}/run.sh {}", ShellQuoted(project_.own), kCaseFile),
                    said_);
  }

  // As runs of the experiment will be: twice the same, once with another seed, once with an obstacle.
  Status RunAsPlanned() {
    say_("running it four times as it will be run: twice the same, with another seed, with an obstacle");
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
      project_.form.taken_over.push_back(Counted(project_.standing.size(), "fixed thing") + " in the arena");
    if (random > 0)
      project_.form.taken_over.push_back(
          fmt::format("{} places where something begins that follow from the seed", random));
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
    if (std::ranges::count(candidates_, from, &ScoreCandidate::from) == 0)
      candidates_.insert(candidates_.begin(), *score);
    project_.score = from;
    project_.scores = {score->first, score->other_seed};
    if (!score->Varies())
      Unsupported("score", "it was the same in all runs, also with an obstacle: it may not be one (--score)");
    return Ok{};
  }

  // How the score differs without obstacles; two runs say little of that.
  Status RunMore() {
    const int runs = first_.seconds <= kShortRun ? kScores : kFewScores;
    say_(fmt::format("running it {} times more without obstacles, to see what is usual", runs - 2));
    for (int seed = 3; seed <= runs; ++seed) {
      const TemporaryFolder folder("adopt");
      TRY(const TrialRun run, RunOnce(folder, static_cast<std::uint64_t>(seed), {}));
      TRY(const double score, ScoreIn(run, project_.score));
      project_.scores.push_back(score);
      if (more_starts_.size() + 2 < kComparedStarts) more_starts_.push_back(run);
      project_.poses.insert(project_.poses.end(), run.poses.begin(), run.poses.end());
    }
    if (std::ranges::min(project_.scores) == 0.0)
      Unsupported("failure", "the score can be 0 without obstacles, so that nothing is less: write one");
    return Ok{};
  }

  // With cases in which it needs no loop functions.
  void CompareWithOurs() {
    std::set<std::string> kinds;
    for (const ArenaBody& robot : project_.robots) kinds.insert(robot.kind);
    EngineQuestion question{.argos_file = fs::absolute(options_.argos_file),
                            .project = folder_,
                            .form = project_.form,
                            .starts = {},
                            .kinds = {kinds.begin(), kinds.end()},
                            .run = [&](const std::string& file) { return RunFile(file); }};
    std::vector<const TrialRun*> starts = {&first_, &other_seed_};
    for (const TrialRun& run : more_starts_) starts.push_back(&run);
    for (const TrialRun* run : starts) {
      const std::optional<sim::ObstacleGene> obstacle = ObstacleInTheWay(project_, *run);
      question.starts.push_back({run, obstacle ? sim::Genome{*obstacle} : sim::Genome()});
    }
    say_("looking whether Gauntlet's own engine would do");
    engine_ = CompareEngines(question);
  }

  // A file of ARGoS as it is, but for the recorder.
  Result<TrialRun> RunFile(const std::string& file) {
    const TemporaryFolder folder("adopt");
    TRY(CheckMade(folder));
    TRY(ArgosTemplate form, MakeArgosTemplate(file, kCaseFile, form_options_));
    static const std::regex seed("random_seed=\"([0-9]+)\"");
    std::smatch found;
    if (!std::regex_search(file, found, seed)) return InvalidInput("the file has no seed");
    form.text = std::regex_replace(form.text, std::regex("@seed@"), found[1].str());
    TRY(WriteFilled(folder.path(), form, /*seed=*/0, {}));
    return RunCaseIn(folder);
  }

  // Error: the experiment would be refused, or it cannot be written.
  Status Write() {
    for (const std::string& path : project_.form.paths)
      if (path.front() == '/')
        Unsupported("the path " + path, "is absolute: if runs write there, those at the same time share it");
    const std::string text = AdoptedExperimentText(project_);
    TRY(ReplaceFile(OwnPath(kCaseFile), project_.form.text, kReadableByAll));
    TRY(ReadCommand({text, project_.name + ".toml"}, {}));
    if (options_.experiment.empty()) return Ok{};
    const fs::path output = fs::absolute(options_.experiment);
    const fs::path beside = output.parent_path() / project_.own;
    std::error_code failed;
    fs::copy(own_.path() + "/" + project_.own, beside, fs::copy_options::recursive, failed);
    if (failed)
      return Error{ErrorKind::kIo, fmt::format("{}: {}", Printable(beside.string()), failed.message())};
    return WriteOutputFile(output, text);
  }

  const AdoptionOptions& options_;
  const std::function<void(const std::string&)>& say_;
  std::ostream& said_;
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
  std::vector<TrialRun> more_starts_;  // without obstacles, with seeds of their own
  EngineComparison engine_;
};

}  // namespace

Result<Adopted> Adopt(const AdoptionOptions& options, const std::function<void(const std::string&)>& say,
                      std::ostream& said) {
  return Adoption(options, say, said).Run();
}

}  // namespace gauntlet
