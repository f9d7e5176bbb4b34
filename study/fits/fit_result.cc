#include "study/fits/fit_result.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "analysis/statistics/rank_test.h"
#include "analysis/statistics/sample.h"
#include "analysis/tables/table.h"
#include "base/number_text.h"
#include "master/campaign/stored_campaign.h"
#include "master/campaign/stored_search.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr double kLikely = 0.9;          // of the accepted values
constexpr std::size_t kPairDraws = 200;  // to find a setting that meets two targets
constexpr int kRulePlaces = 1000;        // that are asked whether they break a rule: .1 % is seen
constexpr double kNormal95 = 1.959964;   // quantile of the normal distribution

std::vector<double> PlacesOf(const std::vector<SettingsPoint>& draws, std::size_t key) {
  std::vector<double> places;
  for (const SettingsPoint& draw : draws) places.push_back(draw[key]);
  return places;
}

std::string ValueText(const VariedKey& key, double place, bool rounded) {
  const KeyValue value = rounded ? key.RoundedAt(place) : key.ValueAt(place);
  if (const auto* number = std::get_if<double>(&value); number != nullptr && !rounded)
    return fmt::format("{:.3g}", *number);
  return ToSet(value);
}

// Choices with their shares, the frequentest first, and whether some of them can be ruled out.
std::pair<std::string, bool> SharesOf(const VariedKey& key, const std::vector<double>& places) {
  std::map<std::string, std::size_t> counts;
  for (const KeyValue& value : key.values) counts[ToSet(value)] = 0;
  for (const double place : places) ++counts[ValueText(key, place, false)];
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const auto& [text, count] : counts) ranked.emplace_back(count, text);
  std::ranges::stable_sort(ranked, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> texts;
  const auto all = static_cast<double>(places.size());
  for (const auto& [count, text] : ranked)
    texts.push_back(fmt::format("{} {:.0f} %", text, 100.0 * static_cast<double>(count) / all));
  const double without_last = 1.0 - static_cast<double>(ranked.back().first) / all;
  return {fmt::format("{}", fmt::join(texts, ", ")), without_last >= kLikely};
}

FittedKey FittedKeyOf(const VariedKey& key, const std::vector<double>& places) {
  FittedKey fitted{.path = key.key.path, .range = key.ToText().substr(key.key.path.size() + 1)};
  if (places.empty()) return fitted;
  if (key.listed()) {
    std::tie(fitted.likely, fitted.determined) = SharesOf(key, places);
    return fitted;
  }
  const double low = analysis::Quantile(places, (1.0 - kLikely) / 2.0);
  const double high = analysis::Quantile(places, (1.0 + kLikely) / 2.0);
  fitted.likely = fmt::format("{} to {}", ValueText(key, low, false), ValueText(key, high, false));
  fitted.determined = high - low <= kUndetermined;
  return fitted;
}

// Spearman's.
double RankCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> ranks_a = analysis::MidRanks(a);
  const std::vector<double> ranks_b = analysis::MidRanks(b);
  const double mean = (static_cast<double>(a.size()) + 1.0) / 2.0;
  double both = 0.0;
  double of_a = 0.0;
  double of_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += (ranks_a[i] - mean) * (ranks_b[i] - mean);
    of_a += (ranks_a[i] - mean) * (ranks_a[i] - mean);
    of_b += (ranks_b[i] - mean) * (ranks_b[i] - mean);
  }
  return of_a > 0.0 && of_b > 0.0 ? both / std::sqrt(of_a * of_b) : 0.0;
}

void AddKeys(FitResult& fit) {
  std::vector<std::vector<double>> places;
  for (std::size_t i = 0; i < fit.plan.varied.size(); ++i) {
    places.push_back(PlacesOf(fit.draws, i));
    fit.keys.push_back(FittedKeyOf(fit.plan.varied[i], places.back()));
    for (std::size_t j = 0; j < i && !fit.draws.empty(); ++j) {
      const double correlation = RankCorrelation(places[j], places[i]);
      if (std::abs(correlation) < kTradeOff) continue;
      fit.trade_offs.push_back({fit.keys[j].path, fit.keys[i].path, correlation});
    }
  }
}

void AddAccepted(FitResult& fit) {
  std::map<SettingsPoint, std::size_t> place_of;
  for (const SettingsPoint& draw : fit.draws) {
    const auto [known, is_new] = place_of.try_emplace(draw, fit.accepted.size());
    if (is_new) fit.accepted.push_back({draw, 0.0});
    fit.accepted[known->second].weight += 1.0 / static_cast<double>(fit.draws.size());
  }
}

// The share of even draws from the ranges that break a rule of the experiment.
double RefusedShare(const FitRounds& rounds) {
  sim::RandomStream random(rounds.seed(), sim::StreamPurpose::kStatistics, 0xFFFFFFFEU);
  SettingsPoint place(rounds.plan().varied.size());
  int refused = 0;
  for (int i = 0; i < kRulePlaces; ++i) {
    for (double& one : place) one = random.Uniform();
    if (!rounds.allowed()(place)) ++refused;
  }
  return static_cast<double>(refused) / kRulePlaces;
}

// The misfit of the best setting for these targets alone, as the posterior has it.
double LeastMisfit(const FitPosterior& posterior, const std::vector<std::size_t>& targets, std::uint64_t seed,
                   const FitPosterior::Allowed& allowed) {
  sim::RandomStream random(seed, sim::StreamPurpose::kStatistics, 0xFFFFFFFFU);
  double least = INFINITY;
  for (const SettingsPoint& place : posterior.Draw(kPairDraws, allowed, random, targets)) {
    double worst = 0.0;
    for (const std::size_t target : targets) worst = std::max(worst, posterior.Misfit(place, target));
    least = std::min(least, worst);
  }
  return least;
}

// Which targets no setting meets: alone, or two of them together.
void AddContradictions(const FitRounds& rounds, const FitPosterior& posterior, FitResult& fit) {
  const auto meets = [&](const std::vector<std::size_t>& targets) {
    return LeastMisfit(posterior, targets, rounds.seed(), rounds.allowed()) <= kMetWithin;
  };
  std::vector<std::size_t> possible;
  for (std::size_t t = 0; t < fit.plan.targets.size(); ++t) {
    if (meets({t})) {
      possible.push_back(t);
    } else {
      fit.contradictions.push_back(fmt::format("No setting within the ranges meets this target: {} ({}).",
                                               fit.plan.targets[t].Title(), fit.plan.targets[t].Wanted()));
    }
  }
  for (std::size_t i = 0; i < possible.size(); ++i) {
    for (std::size_t j = i + 1; j < possible.size(); ++j) {
      if (meets({possible[i], possible[j]})) continue;
      const FitTarget& one = fit.plan.targets[possible[i]];
      const FitTarget& other = fit.plan.targets[possible[j]];
      fit.contradictions.push_back(
          fmt::format("Two targets contradict each other: {} ({}) and {} ({}). Each alone can be met.",
                      one.Title(), one.Wanted(), other.Title(), other.Wanted()));
    }
  }
}

// 95 %, of a statistic that stands on so many runs, each of which has the variance.
analysis::Interval IntervalOf(const FitTarget& target, double ours, double variance, double runs) {
  if (!target.formula.empty())
    return analysis::WilsonInterval(static_cast<std::uint32_t>(std::lround(ours * runs)),
                                    static_cast<std::uint32_t>(runs), analysis::kConfidence);
  const double error = kNormal95 * std::sqrt(variance / runs);
  return {ours - error, ours + error};
}

void AddJudgement(const FitRounds& rounds, FitResult& fit) {
  const std::size_t last = rounds.settings().size() - 1;
  const FitSetting& setting = rounds.settings()[last];
  const SettingStatistics statistics = rounds.StatisticsOf(last);
  std::size_t component = 0;
  for (const FitTarget& target : fit.plan.targets) {
    const std::size_t count = target.values.size();
    const auto at = static_cast<Eigen::Index>(component);
    const auto size = static_cast<Eigen::Index>(count);
    const double runs = statistics.runs[component];
    const std::vector<double> ours(
        statistics.values.begin() + static_cast<std::ptrdiff_t>(component),
        statistics.values.begin() + static_cast<std::ptrdiff_t>(component + count));
    const Eigen::MatrixXd each = statistics.covariance.block(at, at, size, size);
    // The measurement has its error too, which is that of so many runs of ours.
    const Eigen::MatrixXd both =
        each / runs + (target.n > 0.0 ? Eigen::MatrixXd(each / target.n) : Eigen::MatrixXd::Zero(size, size));
    JudgedTarget judged{.title = target.Title(), .wanted = target.Wanted()};
    judged.misfit = MisfitOf(target, ours, both);
    judged.ours = analysis::Describe(ours).mean;
    judged.interval = IntervalOf(target, judged.ours, each.mean(), runs);
    judged.met =
        target.demand == FitTarget::Demand::kEvery ? ours.front() == 1.0 : judged.misfit <= kMetWithin;
    fit.targets.push_back(std::move(judged));
    component += count;
  }
  const std::vector<KeyValue> values = setting.ValuesOf(fit.plan.varied);
  fit.chosen.emplace();
  for (std::size_t i = 0; i < values.size(); ++i) {
    fit.chosen->push_back(fit.plan.varied[i].PlaceOf(values[i]));
    fit.keys[i].chosen = ToSet(values[i]);
  }
  fit.fitted = WithValues(fit.experiment, fit.plan.varied, values);
  fit.fitted->search.algorithm = fit.experiment.fit.search;
  fit.fitted->name += "-fitted";
}

}  // namespace

bool FitResult::Met() const {
  return !targets.empty() && std::ranges::all_of(targets, &JudgedTarget::met);
}

FitResult ResultOf(const Experiment& experiment, const FitRounds& rounds, bool finished) {
  FitResult fit{.experiment = experiment, .plan = rounds.plan(), .finished = finished, .why = rounds.why()};
  for (const FitSetting& setting : rounds.settings()) {
    fit.runs += static_cast<std::uint64_t>(setting.runs);
    fit.without_result += static_cast<std::uint64_t>(setting.without_result);
    ++(setting.judged ? fit.candidates : fit.settings);
  }
  fit.refused = RefusedShare(rounds);
  const std::unique_ptr<FitPosterior> posterior = rounds.Posterior();
  if (posterior != nullptr) fit.draws = rounds.Accepted(*posterior);
  AddAccepted(fit);
  AddKeys(fit);
  const bool judged = !rounds.settings().empty() && rounds.settings().back().judged &&
                      std::ranges::none_of(rounds.settings().back().values, &std::vector<double>::empty);
  if (judged) AddJudgement(rounds, fit);
  if (posterior != nullptr && finished && !fit.Met()) AddContradictions(rounds, *posterior, fit);
  return fit;
}

Result<FitResult> ReadFit(const std::string& dir) {
  TRY(const StoredCampaign campaign, OpenStoredCampaign(dir));
  const SearchPlan& plan = campaign.plans.front();
  ResultStore& store = *campaign.view.store;
  TRY(const auto search, MakeStoredSearch(plan, store));
  if (search->Fit() == nullptr || campaign.plans.size() != 1)
    return InvalidInput(fmt::format("{} holds no fit: gauntlet fit makes one", dir));
  TRY(RestoreSearch(plan.id, store, *search));
  TRY(const std::vector<StoredSearch> stored, store.LoadSearches());
  const bool finished = std::ranges::any_of(stored, [&](const StoredSearch& one) {
    return one.id == plan.id && HasFinished(one, plan.experiment, *search);
  });
  return ResultOf(plan.experiment, *search->Fit(), finished);
}

std::string AcceptedCsv(const FitResult& fit) {
  std::vector<Column> columns = {"weight"};
  for (const VariedKey& key : fit.plan.varied) columns.emplace_back(key.key.path);
  Table table(std::move(columns));
  for (const AcceptedSetting& one : fit.accepted) {
    std::vector<Cell> row = {Cell(one.weight)};
    for (std::size_t i = 0; i < one.place.size(); ++i)
      row.emplace_back(ToSet(fit.plan.varied[i].ValueAt(one.place[i])));
    table.AddRow(std::move(row));
  }
  return table.ToCsv();
}

std::string FittedToml(const FitResult& fit, const std::string& dir) {
  std::vector<std::string> header = {
      fmt::format("{}, fitted by gauntlet fit in the campaign {}.", fit.experiment.name, dir), ""};
  for (const JudgedTarget& target : fit.targets)
    header.push_back(fmt::format("{}: wanted {}, got {:.4g} ({:.4g} to {:.4g}){}", target.title,
                                 target.wanted, target.ours, target.interval.low, target.interval.high,
                                 target.met ? "" : ": NOT MET"));
  return WriteExperiment(*fit.fitted, header, BuiltInCatalogue());
}

}  // namespace gauntlet
