#include "report/ui/served_campaigns.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
#include "base/split.h"
#include "report/figures/campaign_figures.h"
#include "report/pages/report_document.h"
#include "report/pages/report_page.h"
#include "report/ui/campaign_feed.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;
using Monotonic = std::chrono::steady_clock;

// Simulated for the first page, to be seen side by side; every other run is simulated when it is asked for.
constexpr std::size_t kShownRuns = 12;
// What is stored is looked at no more often than this, and events at least as often as that.
constexpr std::chrono::seconds kBetweenLooks{1};
constexpr std::chrono::seconds kLongestBetweenLooks{5};

HttpAnswer JsonAnswer(const Json& json) {
  return {.type = "application/json", .body = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

HttpAnswer Gone(const Error& error) {
  return {.status = 410, .body = error.message + "\n"};
}

HttpAnswer NoSuchPage() {
  return {.status = 404, .body = "there is no such page\n"};
}

Json EventsJson(const std::vector<StoredEvent>& events) {
  Json json = Json::array();
  for (const StoredEvent& one : events)
    json.push_back({{"unix_ms", one.unix_ms}, {"kind", one.kind}, {"text", one.text}});
  return json;
}

}  // namespace

// A campaign that is followed.
struct ServedCampaigns::Followed {
  explicit Followed(const std::string& dir) : directory(dir), feed(dir) {}

  // Looks when there is news, or when it is time.
  Status Look(const Json& status) {
    const auto runs = status.value("runs_done", std::uint64_t{0});
    const auto since = Monotonic::now() - looked;
    const bool news = runs != runs_then || status.value("state", "") != state_then;
    if (looks > 0 &&
        since < (news ? Monotonic::duration(kBetweenLooks) : Monotonic::duration(kLongestBetweenLooks)))
      return Ok{};
    TRY(feed.Look());
    ++looks;
    looked = Monotonic::now();
    runs_then = runs;
    state_then = status.value("state", "");
    return Ok{};
  }

  // What is known of the campaign, read anew when the run is not among it; 0 = whatever is known.
  Result<std::shared_ptr<const CampaignFacts>> FactsWith(RunId run) {
    const std::lock_guard lock(mutex);
    if (facts != nullptr && run == 0) return facts;
    if (facts != nullptr && std::ranges::find(facts->runs, run, &RunFacts::id) != facts->runs.end())
      return facts;
    TRY(CampaignFacts read, ReadFacts(directory));
    facts = std::make_shared<const CampaignFacts>(std::move(read));
    return facts;
  }

  void Remember(const CampaignFacts& read) {
    const std::lock_guard lock(mutex);
    facts = std::make_shared<const CampaignFacts>(read);
  }

  const std::string directory;
  std::mutex mutex;  // guards the rest
  CampaignFeed feed;
  std::uint64_t looks = 0;
  Monotonic::time_point looked;
  std::uint64_t runs_then = 0;
  std::string state_then;
  std::shared_ptr<const CampaignFacts> facts;  // as they were read last
};

Result<std::unique_ptr<ServedCampaigns>> ServedCampaigns::Open(const std::vector<std::string>& sets,
                                                               CampaignService& campaigns) {
  TRY(GatherReport(sets, 0));
  return std::unique_ptr<ServedCampaigns>(new ServedCampaigns(sets, campaigns));
}

ServedCampaigns::ServedCampaigns(std::vector<std::string> sets, CampaignService& campaigns)
    : sets_(std::move(sets)), campaigns_(campaigns) {}

ServedCampaigns::~ServedCampaigns() = default;

std::vector<std::shared_ptr<ServedCampaigns::Followed>> ServedCampaigns::FollowedNow() {
  const Result<std::vector<std::string>> directories = CampaignsNamed(sets_);
  const std::lock_guard lock(mutex_);
  const auto is_there = [&](const auto& one) { return std::ranges::count(*directories, one->directory) > 0; };
  if (!directories || !std::ranges::all_of(followed_, is_there)) return followed_;
  std::vector<std::shared_ptr<Followed>> now;
  for (const std::string& directory : *directories) {
    const auto before =
        std::ranges::find(followed_, directory, [](const auto& one) { return one->directory; });
    now.push_back(before == followed_.end() ? std::make_shared<Followed>(directory) : *before);
  }
  followed_ = std::move(now);
  return followed_;
}

HttpAnswer ServedCampaigns::Answer(const std::string& path) {
  const std::vector<std::string> parts = Split(path, '/');  // "run/0/17"
  if (path.empty()) return AnswerPages();
  if (path == "status") return AnswerStatus();
  std::vector<std::uint64_t> numbers;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto number = ParseNumber<std::uint64_t>(parts[i]);
    if (!number) return NoSuchPage();
    numbers.push_back(*number);
  }
  const std::vector<std::shared_ptr<Followed>> followed = FollowedNow();
  if (numbers.empty() || numbers[0] >= followed.size()) return NoSuchPage();
  Followed& campaign = *followed[numbers[0]];
  if (parts[0] == "progress" && numbers.size() <= 2)
    return AnswerProgress(campaign, numbers.size() == 2 ? numbers[1] : 0);
  if (parts[0] == "cases" && numbers.size() == 1) return AnswerCases(campaign);
  if (parts[0] == "run" && numbers.size() == 2) return AnswerRun(campaign, numbers[0], numbers[1]);
  return NoSuchPage();
}

HttpAnswer ServedCampaigns::AnswerPages() {
  Result<Report> report = GatherReport(sets_, kShownRuns);
  if (!report) return Gone(report.error());
  report->served = true;
  const std::vector<std::shared_ptr<Followed>> followed = FollowedNow();
  for (CampaignPages& pages : report->campaigns) {
    pages.every_run = true;
    const auto one =
        std::ranges::find(followed, pages.facts.directory, [](const auto& f) { return f->directory; });
    if (one != followed.end()) (*one)->Remember(pages.facts);
  }
  return {.type = "text/html; charset=utf-8", .body = ReportPage(*report)};
}

HttpAnswer ServedCampaigns::AnswerStatus() {
  Json all = Json::array();
  for (const std::shared_ptr<Followed>& one : FollowedNow()) {
    const std::lock_guard lock(one->mutex);
    Json json = {{"directory", one->directory},
                 {"error", nullptr},
                 {"status", nullptr},
                 {"events", Json::array()},
                 {"toughest", nullptr}};
    const Result<std::string> text = campaigns_.ReadStatus(one->directory);
    const Json status = text ? Json::parse(*text, nullptr, /*allow_exceptions=*/false) : Json::object();
    const Status looked = text ? one->Look(status) : text.error();
    if (looked) {
      json["status"] = status;
    } else {
      json["error"] = looked.error().message;
    }
    json["events"] = EventsJson(one->feed.events());
    if (const RunFacts* toughest = one->feed.toughest())
      json["toughest"] = {{"run", toughest->id}, {"fitness", toughest->fitness}};
    json["courses"] = one->feed.courses().size();
    all.push_back(std::move(json));
  }
  return JsonAnswer({{"campaigns", std::move(all)}});
}

HttpAnswer ServedCampaigns::AnswerProgress(Followed& followed, std::size_t course) {
  const std::lock_guard lock(followed.mutex);
  const std::vector<SearchCourse> courses = followed.feed.courses();
  if (course >= courses.size()) return NoSuchPage();
  return {.type = "image/svg+xml", .body = FiguresOf(courses, {})[course].svg()};
}

HttpAnswer ServedCampaigns::AnswerCases(Followed& followed) {
  const Result<std::shared_ptr<const CampaignFacts>> known = followed.FactsWith(0);
  if (!known) return Gone(known.error());
  return JsonAnswer(CaseTable(**known, (*known)->cases.size()).ToJsonRows());
}

HttpAnswer ServedCampaigns::AnswerRun(Followed& followed, std::size_t campaign, RunId run) {
  const Result<std::shared_ptr<const CampaignFacts>> known = followed.FactsWith(run);
  if (!known) return Gone(known.error());
  const CampaignFacts& facts = **known;
  const Result<std::vector<ShownRun>> shown = ShowRuns(facts, {run});
  if (!shown) {
    if (shown.error().kind == ErrorKind::kNotFound)
      return {.status = 404, .body = shown.error().message + "\n"};
    return Gone(shown.error());
  }
  const ShownRun& one = shown->front();
  Json json = {{"page", CaseHtml(facts, campaign, one)}, {"replay", nullptr}};
  if (!one.figure.result.trajectory.empty()) json["replay"] = ReplayDocument(one.figure);
  return JsonAnswer(json);
}

}  // namespace gauntlet
