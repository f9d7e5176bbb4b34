#include "cli/adopt/engine_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/key.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "base/system/process_call.h"
#include "base/system/program_path.h"
#include "base/system/temporary_folder.h"
#include "proto/case_json.h"
#include "search/cases/argos_controllers.h"
#include "search/cases/case_file.h"
#include "sim/arena/color.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSources = 5000;
constexpr std::size_t kMostSourceBytes = std::size_t{1} << 20;
constexpr std::size_t kMostCaseFile = std::size_t{16} << 20;
constexpr std::chrono::minutes kLongestCall{5};

bool IsSource(const fs::path& path) {
  const std::string ending = path.extension();
  return ending == ".cpp" || ending == ".cc" || ending == ".cxx";
}

std::string SourceText(const fs::path& path) {
  const Result<std::string> text = ReadSmallFile(path, kMostSourceBytes);
  return text ? *text : "";
}

Result<std::string> Gauntlet(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), MasterProgramPath());
  TRY(const CallOutput done, CallProcess(arguments, "", {.deadline = kLongestCall}));
  if (done.exit_code <= 1) return done.out;  // 1: something failed in the simulated world
  std::vector<std::string> lines = Split(Trimmed(done.err), '\n');
  const auto of_compiler =
      std::ranges::find_if(lines, [](const std::string& line) { return line.find("error: ") != line.npos; });
  const std::string line(Trimmed(of_compiler == lines.end() ? lines.back() : *of_compiler));
  constexpr std::string_view kName = "gauntlet: ";
  return InvalidInput(line.starts_with(kName) ? line.substr(kName.size()) : line);
}

// Of what `replay --csv` writes: tick, time, robot, x, y, heading and more.
std::vector<Pose> PosesIn(const std::string& csv) {
  std::vector<Pose> poses;
  for (const std::string& line : Split(csv, '\n')) {
    const std::vector<std::string> fields = Split(line, ',');
    if (fields.size() < 6) continue;
    const auto time = ParseNumber<double>(fields[1]);
    const auto x = ParseNumber<double>(fields[3]);
    const auto y = ParseNumber<double>(fields[4]);
    if (time && x && y) poses.push_back({.x = *x, .y = *y, .time = *time, .robot = fields[2]});
  }
  return poses;
}

std::vector<Pose> At(const std::vector<Pose>& places, double time) {
  std::vector<Pose> then;
  std::ranges::copy_if(places, std::back_inserter(then),
                       [&](const Pose& place) { return std::abs(place.time - time) < 1e-6; });
  return then;
}

double Distance(const Pose& a, const Pose& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

// How far each robot is apart then; robots are the same that begin at the same place. Error: one is missing.
Result<std::vector<double>> Apart(const std::vector<Pose>& ours, const std::vector<Pose>& argos,
                                  double time) {
  std::vector<double> apart;
  const std::vector<Pose> ours_then = At(ours, time);
  const std::vector<Pose> argos_then = At(argos, time);
  const std::vector<Pose> argos_first = At(argos, 0.0);
  for (const Pose& start : At(ours, 0.0)) {
    const auto same =
        std::ranges::min_element(argos_first, {}, [&](const Pose& other) { return Distance(start, other); });
    const auto here = std::ranges::find(ours_then, start.robot, &Pose::robot);
    const auto there = same == argos_first.end() ? argos_then.end()
                                                 : std::ranges::find(argos_then, same->robot, &Pose::robot);
    if (here == ours_then.end() || there == argos_then.end())
      return InvalidInput(fmt::format("a robot is missing after {} s", NumberText(time)));
    apart.push_back(Distance(*here, *there));
  }
  return apart;
}

double Median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0.0 : values[values.size() / 2];
}

std::string EngineExperiment(const EngineQuestion& question, std::size_t robots, const sim::Vec2& center) {
  std::string text = fmt::format(
      "name = \"engine\"\nscenario = \"generic\"\ncontroller = {}\nplugins = [\"libengine.so\"]\n"
      "[scenario_parameters]\nrobots = {}\ntime_limit = {}\n"
      "[generic]\nfitness = \"displacement\"\nfailure = \"displacement < 0\"\n",
      QuoteToml(question.form.controllers.front()), robots, NumberText(question.form.length));
  for (const ArgosLight& light : question.form.lights)
    text += fmt::format("[[generic.light]]\nx = {}\ny = {}\nheight = {}\nintensity = {}\ncolor = \"{}\"\n",
                        NumberText(light.position.x() - center.x()),
                        NumberText(light.position.y() - center.y()), NumberText(light.height),
                        NumberText(light.intensity), sim::ColorNamed(light.color) ? light.color : "yellow");
  return text;
}

class Comparison {
 public:
  explicit Comparison(const EngineQuestion& question) : question_(question) {}

  Status Compile(const std::vector<std::string>& sources) {
    if (folder_.path().empty()) return InvalidInput("no folder can be made in $TMPDIR or /tmp");
    std::vector<std::string> command = {"build-controller"};
    std::set<std::string> folders = {question_.project};
    for (const std::string& source : sources) {
      command.push_back(source);
      for (fs::path folder = fs::path(source).parent_path();
           folder.string().starts_with(question_.project) && folder != question_.project;
           folder = folder.parent_path())
        folders.insert(folder);
    }
    for (const std::string& folder : folders) command.insert(command.end(), {"-I", folder});
    command.insert(command.end(), {"--argos", question_.argos_file, "-o", Own("libengine.so")});
    TRY(Gauntlet(command));
    return Ok{};
  }

  Status Compare(EngineComparison& made) {
    TRY(WriteCases());
    std::vector<std::string> evaluate = {"evaluate", Own("engine.toml"), "--dir", Own("runs"), "--quiet"};
    for (const std::string& file : cases_) evaluate.insert(evaluate.end(), {"--case", file});
    TRY(Gauntlet(evaluate));
    TRY(const std::vector<std::string> runs, Runs());
    TRY(Gauntlet(Exporting(runs)));
    std::vector<double> soon;
    std::vector<double> at_end;
    for (const std::string& run : runs) {
      TRY(Gauntlet({"replay", Own("runs"), run, "--csv", Own("ours.csv")}));
      TRY(const std::string csv, ReadSmallFile(Own("ours.csv"), std::size_t{1} << 30));
      TRY(const std::string file, ReadSmallFile(Own(fmt::format("argos/run-{}.argos", run)), kMostCaseFile));
      TRY(const TrialRun there, question_.run(file));
      const std::vector<Pose> ours = PosesIn(csv);
      for (auto* const apart : {&soon, &at_end}) {
        TRY(const std::vector<double> one, Apart(ours, there.poses, apart == &soon ? made.seconds : End()));
        apart->insert(apart->end(), one.begin(), one.end());
      }
    }
    made.cases = static_cast<int>(runs.size());
    made.robots = static_cast<int>(soon.size());
    made.near =
        static_cast<int>(std::ranges::count_if(soon, [](double apart) { return apart <= kSamePlace; }));
    made.apart = Median(soon);
    made.apart_at_end = Median(at_end);
    return Ok{};
  }

  // s, of the last row that both have.
  double End() const { return std::floor(question_.form.length + 1e-9); }

 private:
  std::string Own(const std::string& name) const { return folder_.path() + "/" + name; }

  // Those that ended: cases that break a rule of ours have none.
  Result<std::vector<std::string>> Runs() const {
    TRY(const std::string text, Gauntlet({"show", Own("runs"), "--json", "--runs"}));
    const nlohmann::json document = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
    std::vector<std::string> runs;
    if (document.contains("runs")) {
      for (const nlohmann::json& run : document["runs"])
        if (run["verdict"] == "completed") runs.push_back(std::to_string(run["id"].get<int>()));
    }
    if (runs.empty()) return InvalidInput("no run of its cases ended there");
    return runs;
  }

  std::vector<std::string> Exporting(const std::vector<std::string>& runs) const {
    std::vector<std::string> command = {"export", Own("runs"),         "--format",
                                        "argos",  "--controller-file", question_.argos_file,
                                        "--out",  Own("argos")};
    for (const std::string& run : runs) command.insert(command.end(), {"--run", run});
    return command;
  }

  Status WriteCases() {
    TRY(const std::string text, ReadSmallFile(question_.argos_file, kMostCaseFile));
    TRY(const LoadedCase loaded, ParseArgos(text, fs::path(question_.argos_file).filename()));
    const sim::Rectangle& arena = question_.form.arena;
    const sim::Vec2 center = (arena.min + arena.max) / 2.0;
    std::size_t robots = 0;
    for (const EngineQuestion::Start& start : question_.starts) {
      for (const bool with_obstacle : {false, true}) {
        sim::TestCase made = loaded.test_case;
        made.name = fmt::format("case-{}", cases_.size() + 1);
        made.start_poses.clear();
        for (const Pose& pose : At(start.run->poses, 0.0))
          made.start_poses.push_back({sim::Vec2(pose.x, pose.y) - center, pose.heading});
        robots = made.start_poses.size();
        made.robots = static_cast<int>(robots);
        for (sim::ObstacleGene gene : with_obstacle ? start.obstacles : sim::Genome()) {
          gene.x -= center.x();
          gene.y -= center.y();
          made.obstacles.push_back(gene);
        }
        cases_.push_back(Own(made.name + ".json"));
        TRY(ReplaceFile(cases_.back(), proto::WriteCaseJson(made), kReadableByAll));
      }
    }
    return ReplaceFile(Own("engine.toml"), EngineExperiment(question_, robots, center), kReadableByAll);
  }

  const EngineQuestion& question_;
  const TemporaryFolder folder_{"engine"};
  std::vector<std::string> cases_;
};

std::string Said(const EngineComparison& made) {
  return fmt::format(
      "{} with these controllers. In {} cases, half of them with an obstacle, {} of {} robots were within "
      "{} m of where ARGoS had them after {} s, half of them within {:.1g} m, and at the end within {:.1g} m",
      made.trusted ? "may be trusted" : "is not to be trusted", made.cases, made.near, made.robots,
      kSamePlace, NumberText(made.seconds), made.apart, made.apart_at_end);
}

}  // namespace

std::vector<std::string> ControllerSources(const std::string& project, const std::string& controller) {
  const std::regex registers(R"(REGISTER_CONTROLLER\s*\(\s*[A-Za-z_0-9:]+\s*,\s*")" + controller + "\"");
  static const std::regex others(
      R"(REGISTER_(LOOP_FUNCTIONS|QTOPENGL_USER_FUNCTIONS|CONTROLLER)|\bint\s+main\s*\()");
  std::error_code failed;
  std::size_t looked_at = 0;
  for (auto entry = fs::recursive_directory_iterator(project, failed); !failed && entry != fs::end(entry);
       entry.increment(failed)) {
    if (!IsSource(entry->path()) || !entry->is_regular_file(failed) || ++looked_at > kMostSources) continue;
    if (!std::regex_search(SourceText(entry->path()), registers)) continue;
    std::vector<std::string> sources = {entry->path()};
    for (const fs::directory_entry& beside : fs::directory_iterator(entry->path().parent_path(), failed)) {
      if (IsSource(beside.path()) && beside.path() != entry->path() &&
          !std::regex_search(SourceText(beside.path()), others))
        sources.push_back(beside.path());
    }
    std::ranges::sort(sources);
    return sources;
  }
  return {};
}

EngineComparison CompareEngines(const EngineQuestion& question) {
  EngineComparison made;
  const auto not_compared = [&](const std::string& why) {
    made.said += (made.said.empty() ? "is not compared: " : ", but the two were not compared: ") + why;
    return made;
  };
  if (question.kinds != std::vector<std::string>{"foot-bot"})
    return not_compared("it has foot-bots alone, and all robots must be some");
  if (question.form.controllers.size() != 1) return not_compared("all robots must have one controller");
  const std::string& controller = question.form.controllers.front();
  const std::vector<std::string> sources = ControllerSources(question.project, controller);
  if (sources.empty())
    return not_compared(fmt::format("no C++ source of {} lies in the project", Printable(controller)));
  Comparison comparison(question);
  if (const Status compiled = comparison.Compile(sources); !compiled)
    return not_compared("the controllers do not compile for it: " + compiled.error().message);
  made.compiles = true;
  made.said = "takes the controllers (gauntlet build-controller)";
  made.seconds = std::min(kComparedAt, std::floor(question.form.length + 1e-9));
  if (const Status compared = comparison.Compare(made); !compared)
    return not_compared(compared.error().message);
  made.trusted = made.near >= kTrustedShare * made.robots;
  made.said = Said(made);
  return made;
}

}  // namespace gauntlet
