// What `gauntlet evaluate` asks: how does the swarm do in given test cases?
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/shell_quoted.h"
#include "master/campaign/verdict_text.h"
#include "proto/json_text.h"
#include "proto/run_text.h"
#include "search/cases/case_file.h"
#include "search/search_table.h"
#include "study/questions/question_table.h"
#include "study/sets/case_set.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 40;  // that are printed; JSON has all

// Whether the cases are simulated under several settings.
bool Swept(const Asking& asking) {
  return asking.experiments.size() > 1;
}

// The next case of the call, which what speaks against it keeps out of its search.
CaseAnswer& AddCase(std::string name, Call& call) {
  return call.cases.emplace_back(CaseAnswer{.name = std::move(name), .search = call.searches.size() - 1});
}

void Simulate(CaseAnswer& one, sim::TestCase test_case, Call& call) {
  SearchPlan& plan = call.searches.back();
  if (const std::optional<CaseRefusal> refusal = RefusalOf(plan.experiment, test_case)) {
    one.refused_rule = refusal->rule;
    one.refused = refusal->message;
    return;
  }
  plan.cases.push_back(std::move(test_case));
}

Call CasesOfFiles(const Asking& asking) {
  std::map<std::string, std::vector<std::string>> notices;  // and the files they are about
  std::vector<std::pair<std::string, Result<LoadedCase>>> all;
  for (const std::string& file : asking.Values("--case")) {
    Result<LoadedCase>& loaded = all.emplace_back(file, LoadCase(file)).second;
    if (!loaded) continue;
    if (!loaded->notice.empty()) notices[loaded->notice].push_back(file);
    // `show` knows the case by its file, and by what the file calls it.
    const std::string file_name = std::filesystem::path(file).filename().string();
    if (std::string& name = loaded->test_case.name; name != file_name)
      name = fmt::format("{} ({})", file_name, name);
  }
  Call call;
  for (const SearchPlan& plan : asking.experiments) {
    call.searches.push_back(plan);
    for (const auto& [file, loaded] : all) {
      CaseAnswer& one = AddCase(file, call);
      if (loaded.ok()) {
        Simulate(one, loaded->test_case, call);
      } else {
        one.refused = loaded.error().message;
      }
    }
    if (call.searches.back().cases.empty()) call.searches.pop_back();
  }
  if (asking.quiet) return call;
  for (const auto& [notice, files] : notices) {
    const std::string others = files.size() > 1 ? fmt::format(" and {} more", files.size() - 1) : "";
    asking.say(fmt::format("{}{}: {}", files.front(), others, notice));
  }
  return call;
}

// What distinguishes runs of the experiments from those that the cases come from, as far as the swarm's task
// goes and they are all alike; "" = nothing.
std::string OtherTask(const Experiment& there, const std::vector<SearchPlan>& here) {
  std::string differences;
  for (const auto& [name, value] : here.front().experiment.scenario_parameters) {
    const auto differs = [&name = name, &value = value](const SearchPlan& plan) {
      const sim::Parameters& parameters = plan.experiment.scenario_parameters;
      return !parameters.contains(name) || parameters.at(name) != value;
    };
    if (std::ranges::any_of(here, differs)) continue;
    const auto other = there.scenario_parameters.find(name);
    if (other == there.scenario_parameters.end() || other->second == value) continue;
    differences +=
        fmt::format("{}{} {} there, {} here", differences.empty() ? "" : "; ", name, other->second, value);
  }
  return differences;
}

// One search for each of the campaigns' searches, so that relatives stay together.
Status AddSearchesOf(const std::vector<CaseSet>& sets, const SearchPlan& asked, Call& call) {
  const Experiment& experiment = asked.experiment;
  const std::size_t first = call.searches.size();
  for (const CaseSet& set : sets) {
    if (set.experiment.scenario != experiment.scenario) {
      return InvalidInput(
          fmt::format("--from {}: its cases are of the scenario '{}', the experiment {} has '{}'", set.place,
                      set.experiment.scenario, experiment.name, experiment.scenario));
    }
    SearchPlan plan = asked;
    if (sets.size() > 1) plan.settings = set.place + (asked.settings.empty() ? "" : ", ") + asked.settings;
    if (RowOf(set.experiment).Related()) plan.experiment.search.algorithm = "resimulation";
    plan.experiment.seed += call.searches.size() - first;
    call.searches.push_back(std::move(plan));
    for (const Individual& member : set.members) {
      CaseAnswer& one = AddCase(fmt::format("{} individual {}", set.place, member.id), call);
      sim::TestCase test_case = member.test_case;
      test_case.name = one.name;
      Simulate(one, std::move(test_case), call);
    }
    if (call.searches.back().cases.empty()) call.searches.pop_back();
  }
  return Ok{};
}

Result<Call> CasesOfCampaigns(const Asking& asking) {
  TRY(const std::vector<CaseSet> sets, ReadCaseSets(asking.Value("--from")));
  Call call;
  for (const SearchPlan& plan : asking.experiments) {
    TRY(AddSearchesOf(sets, plan, call));
  }
  for (const CaseSet& set : sets) {
    if (asking.quiet) break;
    for (const std::string& note : set.notes) asking.say(note);
    if (const std::string other = OtherTask(set.experiment, asking.experiments); !other.empty())
      asking.say(fmt::format("{}: scenario_parameters differ from the experiment's: {}", set.place, other));
  }
  return call;
}

Result<Call> PlanEvaluation(const Asking& asking) {
  if (asking.Has("--case") == asking.Has("--from"))
    return InvalidInput("which cases? Either --case FILE... or --from DIR[:SUBSET]");
  if (asking.Has("--from")) return CasesOfCampaigns(asking);
  return CasesOfFiles(asking);
}

// A case whose runs were told.
struct Evaluation {
  double fitness_sum = 0.0;  // of the completed runs
  std::size_t completed = 0;
  std::size_t failures = 0;
  std::size_t without_result = 0;
  std::size_t left_out = 0;  // of these (StartsProgram)
  const CaseRun* toughest = nullptr;

  explicit Evaluation(const CaseAnswer& answer) {
    for (const CaseRun& run : answer.runs) {
      if (run.result.failure.total) ++failures;
      if (run.result.verdict != sim::Verdict::kCompleted) {
        ++without_result;
        left_out += static_cast<std::size_t>(run.became.tally.refused);
        continue;
      }
      fitness_sum += run.result.fitness;
      ++completed;
      if (toughest == nullptr || run.result.fitness < toughest->result.fitness) toughest = &run;
    }
  }
  double Mean() const { return fitness_sum / static_cast<double>(completed); }  // NaN without any
};

// A run may still be refused when the swarm is set up (no room to spawn): that is the case's fault too.
// Unless it is one of a program's that are left out.
CaseAnswer WithRefusal(CaseAnswer answer) {
  if (const FailureTally tally = answer.tally(); tally.refused > 0 && !tally.mostly_refused()) return answer;
  for (const CaseRun& run : answer.runs) {
    if (run.result.verdict != sim::Verdict::kRefused || !answer.refused.empty()) continue;
    answer.refused_rule = RuleOf(run.result.message);
    answer.refused = run.result.message;
  }
  return answer;
}

std::string WhyRefused(const CaseAnswer& answer) {
  const std::string& message = answer.refused;
  if (answer.refused_rule.empty())
    return message.starts_with(answer.name) ? message : fmt::format("{}: {}", answer.name, message);
  const std::string rule = answer.refused_rule + ": ";
  return fmt::format("{}: refused, {}{}", answer.name, message.starts_with(rule) ? "" : rule, message);
}

std::string RemarkOn(const CaseAnswer& answer, const Evaluation& evaluation) {
  if (!answer.refused_rule.empty()) return "refused: " + answer.refused_rule;
  if (answer.runs.empty()) return answer.refused.empty() ? "" : "error";
  if (evaluation.without_result == 0) return "";
  const auto first = std::ranges::find_if(
      answer.runs, [](const CaseRun& run) { return run.result.verdict != sim::Verdict::kCompleted; });
  return fmt::format("{} without a result: {}", evaluation.without_result, NameOf(first->result.verdict));
}

// All cases under the same settings.
struct Sum {
  double fitness = 0.0;
  std::size_t evaluated = 0;
  std::size_t runs = 0;
  std::size_t failures = 0;
  const CaseRun* toughest = nullptr;

  explicit Sum(std::span<const Evaluation> all) {
    for (const Evaluation& one : all) {
      runs += one.completed + one.without_result - one.left_out;
      failures += one.failures;
      if (one.toughest == nullptr) continue;
      fitness += one.Mean();
      ++evaluated;
      if (toughest == nullptr || one.toughest->result.fitness < toughest->result.fitness)
        toughest = one.toughest;
    }
  }
  double Mean() const { return fitness / static_cast<double>(evaluated); }  // NaN without any
};

// Of each combination of a sweep.
Table SumsOf(std::span<const SearchPlan> plans, std::span<const Evaluation> all) {
  Table table({{"settings", "settings"},
               ForPrograms("seed"),
               {">cases", "cases"},
               {">mean fitness", "fitness"},
               {">runs", "runs"},
               {">total failures", "total_failures"}});
  const std::size_t cases = all.size() / plans.size();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const Sum sum(all.subspan(i * cases, cases));
    table.AddRow({plans[i].settings, fmt::format("{}", plans[i].experiment.seed), CountCell(sum.evaluated),
                  FitnessCell(sum.Mean()), CountCell(sum.runs), CountCell(sum.failures)});
  }
  return table;
}

// The mean of all cases and how often they failed, and how to see the toughest run.
void Conclude(const Asking& asking, const Call& call, std::span<const Evaluation> all, Told& told) {
  const Sum sum(all);
  const CaseRun* toughest = sum.toughest;
  if (toughest == nullptr) {
    told.conclusion = Conclusion::kRefused;
    return;
  }
  if (!Swept(asking))
    told.section.sentences.push_back(fmt::format("{} case{}: mean fitness {}, {} of {} runs total failures",
                                                 FormatCount(sum.evaluated), sum.evaluated == 1 ? "" : "s",
                                                 FormatFitness(sum.Mean()), FormatCount(sum.failures),
                                                 FormatCount(sum.runs)));
  const std::string dir = PastedPath(call.directory);
  told.section.commands = {
      {fmt::format("{} replay {} {} --svg {}.svg", asking.program, dir, proto::RunText(toughest->id),
                   proto::RunFileName(toughest->id)),
       "see the toughest of these runs"},
      {fmt::format("{} show {} --json", asking.program, dir), "everything, for scripts"}};
}

Result<Told> TellEvaluation(const Asking& asking, const Call& call, std::span<const CaseAnswer> answers) {
  Told told;
  const bool swept = Swept(asking);
  Table table({swept ? Column("settings", "settings") : ForPrograms("settings?"),
               {"file", "file"},
               {">fitness", "fitness"},
               ForPrograms("refused"),
               ForPrograms("error"),
               {">runs", "runs"},
               {">total failures"},
               {">first run"},
               {""}});
  std::vector<Evaluation> all;
  const std::size_t cases = swept ? answers.size() / asking.experiments.size() : answers.size();
  for (const CaseAnswer& answer : answers) {
    const CaseAnswer one = WithRefusal(answer);
    const Cell settings = swept ? Cell(asking.experiments[all.size() / cases].settings) : TextCell("");
    const Evaluation& evaluation = all.emplace_back(answer);
    const bool simulated = !one.runs.empty();
    table.AddRow({settings, one.name, FitnessCell(evaluation.Mean()), Cell("", TextValue(one.refused_rule)),
                  Cell("", TextValue(one.refused)),
                  JsonCell(TableOf(one.runs).ToJson(), simulated ? FormatCount(one.runs.size()) : "-"),
                  simulated ? CountCell(evaluation.failures) : Cell(),
                  simulated ? Cell(proto::RunText(one.runs.front().id), one.runs.front().id) : Cell(),
                  RemarkOn(one, evaluation)});
    // A file that cannot be read is so under all settings.
    if (const std::string why = WhyRefused(one);
        !one.refused.empty() && std::ranges::count(told.messages, why) == 0)
      told.messages.push_back(why);
  }
  Json json = {{"cases", table.ToJson()}};
  if (swept) {
    const Table sums = SumsOf(asking.experiments, all);
    json["sweep"] = sums.ToJson();
    if (cases > 1) told.details = "\n" + sums.ToText();
  }
  if (call.summary != nullptr) {
    json["experiment"] = call.summary->experiment;
    json["directory"] = call.directory;
    if (!swept) {
      json["seed"] = fmt::format("{}", call.summary->searches.front().seed);
      json["state_hash"] = call.summary->searches.front().state_hash;
    }
    json["finished"] = call.summary->finished;
  }
  told.json = JsonText(json);
  told.section.table = table.First(kMostRows);
  if (table.size() > kMostRows)
    told.section.sentences.push_back(
        fmt::format("and {} more; --json tells all", FormatCount(table.size() - kMostRows)));
  Conclude(asking, call, all, told);
  return told;
}

constexpr const char* kEvaluateHelp =
    R"(Simulates each case and prints its fitness (mean of the replicates; lower = tougher). A case that
breaks a validity rule is refused by the rule's name; the others go on. Exit 2 when all were refused.
Of .argos files the arena, the boxes, the foot-bots and where they start are read.

With --from every individual that has a run in the subset is simulated once (K times with --replicates),
clones included: a population of twenty gives twenty cases, as in the thesis, also when some are copies of
each other. Seeds are fresh: no run of a search has them. What comes of it is a campaign on which 'compare',
'show' and 'replay' work; it has one search for each search that the cases come from, and 'compare' knows
that the members of one evolution's population are relatives.

With --stdin cases come line by line, as JSON objects {"id", "case" or "file", "set", "seed", "replicates"}, and
each is answered by a line on stdout once its runs are stored: for searches of other programs, of which
clients/python has a client. All of them are one campaign. The same command with --dir goes on with it; answers
that were given are given again by their ids. Messages go to stderr. The page is docs/evaluate-stdin.md.

With --sweep or --seeds every case is simulated under each combination, in a search of its own, and the mean of
all cases is told for each. Where --seeds does not say otherwise, a case has the same seeds in all of them.

Examples:
  gauntlet evaluate flocking --case one-wall.json --replicates 20
  gauntlet evaluate flocking --case cases/*.json --replicates 100 --dry-run
  gauntlet evaluate flocking-improved --case cases/*.argos --json > improved.json
  gauntlet evaluate flocking --from campaigns/evolved-1,campaigns/evolved-2 --dir campaigns/f-f
  gauntlet evaluate flocking --from campaigns/evolved-1 --set controller=flocking-improved
  gauntlet evaluate flocking --from campaigns/random:worst:100
  gauntlet evaluate flocking --stdin --dir campaigns/mine < lines.jsonl > answers.jsonl
  gauntlet evaluate flocking --case cases/*.json --replicates 20 --sweep random_faults.count=0,1,2,3)";

}  // namespace

Question EvaluateQuestion() {
  using Kind = QuestionOption::Kind;
  return {.name = "evaluate",
          .summary = "simulate given test cases: files, or those of a campaign",
          .help = kEvaluateHelp,
          .place = Question::Place::kNewCampaign,
          .streams = true,
          .sweeps = true,
          .options = {{"--case", "FILE...", "case files, .json or .argos; several may follow", Kind::kFiles},
                      {"--from", "DIR[:SUBSET]",
                       "the cases of campaigns instead, subsets as in 'gauntlet compare' (default: final)"},
                      {"--replicates", "K", "runs per case, each with its own seed", Kind::kValue,
                       "search.replicates"}},
          .plan = PlanEvaluation,
          .tell = TellEvaluation};
}

}  // namespace gauntlet
