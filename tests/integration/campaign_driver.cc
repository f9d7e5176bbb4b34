#include "tests/integration/campaign_driver.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "tests/support/paths.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {

std::string GauntletPath() {
  return std::string(GAUNTLET_BINARY_DIR) + "/gauntlet";
}
std::string WorkerPath() {
  return std::string(GAUNTLET_BINARY_DIR) + "/gauntlet-worker";
}
std::string FaultShimPath() {
  return GAUNTLET_FAULT_SHIM;
}

namespace {

// pid, state, parent and command line of those that live.
std::string Describe(const std::vector<pid_t>& pids) {
  std::string text;
  for (const pid_t pid : pids) {
    if (!Alive(pid)) continue;
    const std::string folder = "/proc/" + std::to_string(pid);
    std::ifstream stat(folder + "/stat");
    std::string line;
    std::getline(stat, line);
    std::ifstream cmdline(folder + "/cmdline");
    std::string command((std::istreambuf_iterator<char>(cmdline)), {});
    std::replace(command.begin(), command.end(), '\0', ' ');
    text += "\n  " + line.substr(0, 60) + " | " + command;
  }
  return text;
}

}  // namespace

std::vector<std::string> GauntletCommand(const std::vector<std::string>& arguments) {
  std::vector<std::string> argv = {GauntletPath()};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  return argv;
}

ProcessResult Gauntlet(const std::vector<std::string>& arguments, std::chrono::seconds deadline) {
  return RunProcess(GauntletCommand(arguments), {}, deadline);
}

std::unique_ptr<Process> StartGauntlet(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& environment) {
  return std::make_unique<Process>(GauntletCommand(arguments), environment);
}

SmallCampaign SmallForaging() {
  SmallCampaign campaign;
  campaign.name = "foraging";
  campaign.experiment = "foraging";
  campaign.settings = {kSanitized ? "scenario_parameters.time_limit=20"
                                  : "scenario_parameters.time_limit=120"};
  return campaign;
}

SmallCampaign SmallPartitioning() {
  SmallCampaign campaign;
  campaign.name = "task_partitioning";
  campaign.experiment = "task-partitioning";
  campaign.settings = {kSanitized ? "scenario_parameters.time_limit=40"
                                  : "scenario_parameters.time_limit=300"};
  return campaign;
}

SmallCampaign SmallSteadyState() {
  SmallCampaign campaign;
  campaign.name = "steady_state";
  campaign.settings = {"search.algorithm=steady-state", "search.lag=5"};
  return campaign;
}

SmallCampaign SmallArchive() {
  SmallCampaign campaign;
  campaign.name = "archive";
  campaign.population = campaign.generations = 0;
  campaign.settings = {"search.algorithm=archive", "search.slots=6",
                       kSanitized ? "search.runs=60" : "search.runs=120"};
  return campaign;
}

SmallCampaign SmallRandom() {
  SmallCampaign campaign;
  campaign.name = "random";
  campaign.population = campaign.generations = 0;
  campaign.settings = {"search.algorithm=random", kSanitized ? "search.cases=300" : "search.cases=1050",
                       "scenario_parameters.time_limit=5"};
  return campaign;
}

SmallCampaign SmallCommand(bool noise) {
  SmallCampaign campaign;
  campaign.name = "command";
  campaign.experiment = GAUNTLET_SOURCE_DIR "/tests/integration/programs/course.toml";
  campaign.settings = {std::string("controller_parameters.noise=") + (noise ? "1" : "0")};
  return campaign;
}

SmallCampaign SmallFit() {
  SmallCampaign campaign;
  campaign.name = "fit";
  campaign.population = campaign.generations = 0;
  campaign.settings = {"search.algorithm=fit",
                       "scenario_parameters.time_limit=5",
                       "fit.vary=controller_parameters.turn_rate=0.5..2 scenario_parameters.birds=4..9",
                       "fit.targets=metric=angular_order value=0.8 n=50; metric=birds_left value=6 n=50",
                       "fit.runs=660",
                       "fit.judged=40"};
  return campaign;
}

SmallCampaign SmallEvaluation() {
  SmallCampaign campaign;
  campaign.name = "evaluation";
  campaign.population = campaign.generations = 0;
  campaign.settings = {kSanitized ? "search.replicates=10" : "search.replicates=60"};
  campaign.case_file = GAUNTLET_SOURCE_DIR "/tests/fuzz/corpus/case_json/empty.json";
  return campaign;
}

std::vector<std::string> CampaignArguments(const std::string& command, const SmallCampaign& campaign,
                                           const std::string& dir) {
  std::vector<std::string> arguments = {command, campaign.experiment, "--dir", dir, "--seed", campaign.seed};
  const auto give = [&](const char* option, const std::string& value) {
    arguments.insert(arguments.end(), {option, value});
  };
  if (campaign.population > 0) give("--population", std::to_string(campaign.population));
  if (campaign.generations > 0) give("--generations", std::to_string(campaign.generations));
  if (!campaign.case_file.empty()) give("--case", campaign.case_file);
  for (const std::string& setting : campaign.settings) give("--set", setting);
  return arguments;
}

std::vector<std::string> EvolveArguments(const SmallCampaign& campaign, const std::string& dir, int workers) {
  const bool evolves = campaign.case_file.empty();
  std::vector<std::string> arguments = CampaignArguments(evolves ? "evolve" : "evaluate", campaign, dir);
  // Its runs are too short for some swarms to get anywhere.
  if (evolves) arguments.emplace_back("--even-if-it-fails-without-obstacles");
  arguments.insert(arguments.end(), {"--workers", std::to_string(workers), "--quiet"});
  return arguments;
}

nlohmann::json Show(const std::string& dir) {
  const ProcessResult result = Gauntlet({"show", dir, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json parsed = nlohmann::json::parse(result.out, nullptr, /*allow_exceptions=*/false);
  EXPECT_FALSE(parsed.is_discarded()) << result.out;
  return parsed.is_discarded() ? nlohmann::json() : parsed;
}

std::string ReadFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(in)), {});
}

std::string StateHash(const std::string& dir) {
  return Show(dir).value("state_hash", "");
}

const std::string& UndisturbedHash(const SmallCampaign& campaign) {
  static std::map<std::vector<std::string>, std::string> hashes;
  std::string& hash = hashes[EvolveArguments(campaign, "", 2)];
  if (hash.empty()) {
    const TemporaryDirectory scratch;
    const ProcessResult result = Gauntlet(EvolveArguments(campaign, scratch / "c", 2));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    hash = StateHash(scratch / "c");
    EXPECT_EQ(hash.size(), 64u);
  }
  return hash;
}

std::chrono::milliseconds RandomTime(sim::RandomStream& random, std::chrono::milliseconds longest) {
  return std::chrono::milliseconds(random.Below(static_cast<std::uint32_t>(longest.count())) + 1);
}

bool KillADescendant(const Process& ancestor, sim::RandomStream& random) {
  const std::vector<pid_t> family = DescendantsOf(ancestor.pid());
  if (family.empty()) return false;
  kill(family[random.Below(static_cast<std::uint32_t>(family.size()))], SIGKILL);
  return true;
}

int EvolveThroughMasterKills(const SmallCampaign& campaign, const std::string& dir, int workers, int kills,
                             std::uint64_t seed, std::chrono::milliseconds longest_life) {
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  int hits = 0;
  std::vector<std::string> arguments = EvolveArguments(campaign, dir, workers);
  for (int kill = 0; kill < kills; ++kill) {
    std::unique_ptr<Process> master = StartGauntlet(arguments);
    const bool ended = Eventually([&] { return !master->Running(); }, RandomTime(random, longest_life));
    if (!ended) {
      const std::vector<pid_t> family = DescendantsOf(master->pid());
      master->Signal(SIGKILL);
      ++hits;
      master->Wait();
      EXPECT_TRUE(Eventually([&] { return std::none_of(family.begin(), family.end(), Alive); },
                             std::chrono::seconds(10)))
          << "outlived their killed master: " << Describe(family);
    }
    // A master killed before it had created its campaign leaves nothing to resume: then the same command is
    // given again.
    if (Gauntlet({"show", dir, "--json"}).exit_code == 0)
      arguments = {"resume", dir, "--workers", std::to_string(workers), "--quiet"};
  }
  const ProcessResult last = Gauntlet(arguments);
  EXPECT_EQ(last.exit_code, 0) << last.err;
  return hits;
}

int EvolveThroughWorkerKills(const SmallCampaign& campaign, const std::string& dir, int workers, int kills,
                             std::uint64_t seed, std::chrono::milliseconds between_kills) {
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, dir, workers));
  // Before there are workers the only child is the one that tells the golden hash.
  EXPECT_TRUE(Eventually([&] { return std::filesystem::exists(dir + "/access.json") || !master->Running(); },
                         kPatience));
  int hits = 0;
  while (hits < kills && !Eventually([&] { return !master->Running(); }, RandomTime(random, between_kills))) {
    hits += KillADescendant(*master, random) ? 1 : 0;
  }
  const ProcessResult result = master->Wait(std::chrono::seconds(300));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return hits;
}

}  // namespace gauntlet::testing_support
