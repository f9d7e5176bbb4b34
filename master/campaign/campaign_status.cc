#include "master/campaign/campaign_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "proto/json_text.h"

namespace gauntlet {
namespace {

using nlohmann::ordered_json;

// Runs that workers have: being simulated, or waiting there.
std::uint64_t RunsOf(const BackendView& backend, bool waiting) {
  std::uint64_t runs = 0;
  for (const WorkerView& worker : backend.workers)
    runs += static_cast<std::uint64_t>(std::ranges::count(worker.leases, waiting, &WorkerView::Lease::waits));
  return runs;
}

// Who wanted to work and may not: "; 2 workers were refused, the last because ...". "" for nobody.
std::string TurnedAway(const BackendView& backend) {
  std::string text;
  const auto were = [](std::uint64_t count, const char* what) {
    return fmt::format("; {} {}{}", count, what, count == 1 ? " was" : "s were");
  };
  if (backend.refused_workers > 0)
    text += were(backend.refused_workers, "worker") + " refused, the last because " + backend.last_refusal;
  if (backend.unknown_keys > 0)
    text += were(backend.unknown_keys, "connection") + " turned away for keys that are not this campaign's";
  if (backend.failed_handshakes > 0)
    text += were(backend.failed_handshakes, "connection") +
            " dropped in the greeting (no keys, wrong ones, or no worker)";
  return text;
}

ordered_json OrNull(const std::string& text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

ordered_json Json(const WorkerView& worker) {
  ordered_json runs = ordered_json::array();
  for (const WorkerView::Lease& lease : worker.leases) {
    runs.push_back({{"run", lease.run},
                    {"lease", fmt::format("{:x}", lease.fence)},
                    {"attempt", lease.attempt},
                    {"state", lease.waits ? "waiting" : "running"},
                    {"seconds", lease.seconds}});
  }
  const WorkerRecord& record = worker.record;
  return {{"worker", worker.label},
          {"pid", worker.pid},
          {"slots", worker.slots},
          {"allocation", worker.allocation},
          {"state", StateOf(worker)},
          {"silent_seconds", worker.silent_seconds},
          {"runs_finished", record.finished},
          {"runs_failed", record.failed},
          {"failures_contradicted", record.contradicted},
          {"bad_answers", record.strikes},
          {"quarantined", OrNull(record.quarantined ? InWords(record) : "")},
          {"runs", std::move(runs)}};
}

ordered_json Json(const AllocationView& allocation) {
  return {{"job", allocation.job},     {"state", allocation.state},     {"reason", allocation.reason},
          {"nodes", allocation.nodes}, {"workers", allocation.workers}, {"cancelled", allocation.cancelled}};
}

enum class Kind { kText, kTextOrNone, kCount, kNumber, kFlag, kObjectOrNone, kList };

struct Field {
  const char* name;
  Kind kind;
  bool required = false;
};

constexpr Field kStatusFields[] = {{"state", Kind::kText, true},
                                   {"master", Kind::kObjectOrNone},
                                   {"unix_ms", Kind::kCount},
                                   {"generation", Kind::kCount},
                                   {"generations", Kind::kCount},
                                   {"runs_done", Kind::kCount},
                                   {"runs_running", Kind::kCount},
                                   {"runs_queued", Kind::kCount},
                                   {"runs_ahead", Kind::kCount},
                                   {"runs_per_second", Kind::kNumber},
                                   {"nondeterministic", Kind::kCount},
                                   {"verdicts_of_one_worker", Kind::kCount},
                                   {"why_nothing_runs", Kind::kTextOrNone},
                                   {"pool_trouble", Kind::kTextOrNone},
                                   {"allocations", Kind::kList},
                                   {"worker_list", Kind::kList, true}};
constexpr Field kMasterFields[] = {{"host", Kind::kText, true},
                                   {"pid", Kind::kCount, true},
                                   {"epoch", Kind::kCount, true},
                                   {"encrypted", Kind::kFlag, true}};
constexpr Field kAllocationFields[] = {{"job", Kind::kText, true},      {"role", Kind::kText},
                                       {"state", Kind::kText, true},    {"reason", Kind::kText, true},
                                       {"nodes", Kind::kText, true},    {"workers", Kind::kCount, true},
                                       {"cancelled", Kind::kFlag, true}};
constexpr Field kWorkerFields[] = {{"worker", Kind::kText, true},
                                   {"state", Kind::kText, true},
                                   {"silent_seconds", Kind::kNumber, true},
                                   {"quarantined", Kind::kTextOrNone},
                                   {"runs", Kind::kList, true}};
constexpr Field kRunFields[] = {{"run", Kind::kCount, true},
                                {"state", Kind::kText},
                                {"attempt", Kind::kCount},
                                {"seconds", Kind::kNumber, true}};

// Whoever adds two counts must not overflow.
constexpr std::uint64_t kMostCounted = 1ULL << 62;

bool Is(const ordered_json& value, Kind kind) {
  switch (kind) {
    case Kind::kText:
      return value.is_string();
    case Kind::kTextOrNone:
      return value.is_string() || value.is_null();
    case Kind::kCount:
      return value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostCounted;
    case Kind::kNumber:
      return value.is_number();
    case Kind::kFlag:
      return value.is_boolean();
    case Kind::kObjectOrNone:
      return value.is_object() || value.is_null();
    case Kind::kList:
      return value.is_array();
  }
  return false;
}

std::string_view InWords(Kind kind) {
  switch (kind) {
    case Kind::kText:
      return "a text";
    case Kind::kTextOrNone:
      return "a text or null";
    case Kind::kCount:
      return "a count";
    case Kind::kNumber:
      return "a number";
    case Kind::kFlag:
      return "true or false";
    case Kind::kObjectOrNone:
      return "an object or null";
    case Kind::kList:
      return "a list";
  }
  return "";
}

// `place`: of the object, "" or with the point that separates it from its fields.
Status CheckFields(const ordered_json& object, std::span<const Field> fields, const std::string& place) {
  if (!object.is_object())
    return Error{ErrorKind::kCorrupt, fmt::format("{} is no object", place.substr(0, place.size() - 1))};
  for (const Field& field : fields) {
    const auto found = object.find(field.name);
    if (found == object.end() ? !field.required : Is(*found, field.kind)) continue;
    return Error{ErrorKind::kCorrupt,
                 fmt::format("{}{} is {}, where {} belongs", place, field.name,
                             found == object.end() ? "missing" : found->type_name(), InWords(field.kind))};
  }
  return Ok{};
}

}  // namespace

Status CheckStatus(const ordered_json& status) {
  TRY(CheckFields(status, kStatusFields, ""));
  if (const auto master = status.find("master"); master != status.end() && master->is_object()) {
    TRY(CheckFields(*master, kMasterFields, "master."));
  }
  const auto check_each = [](const ordered_json& object, const char* list, const std::string& place,
                             const auto& check) -> Status {
    const auto found = object.find(list);
    for (std::size_t i = 0; found != object.end() && i < found->size(); ++i) {
      TRY(check((*found)[i], fmt::format("{}{}[{}].", place, list, i)));
    }
    return Ok{};
  };
  const auto check_allocation = [](const ordered_json& allocation, const std::string& place) {
    return CheckFields(allocation, kAllocationFields, place);
  };
  const auto check_run = [](const ordered_json& run, const std::string& place) {
    return CheckFields(run, kRunFields, place);
  };
  const auto check_worker = [&](const ordered_json& worker, const std::string& place) -> Status {
    TRY(CheckFields(worker, kWorkerFields, place));
    return check_each(worker, "runs", place, check_run);
  };
  TRY(check_each(status, "allocations", "", check_allocation));
  return check_each(status, "worker_list", "", check_worker);
}

std::string WhyNothingRuns(const MasterView& master, const CampaignProgress& progress,
                           const BackendView& backend) {
  if (RunsOf(backend, false) > 0) return "";
  if (progress.search.finished) return "the search has finished";
  if (master.stopping) return "the campaign is stopping: no more runs are given away";
  const auto lost = std::ranges::count(backend.workers, true, &WorkerView::lost);
  const auto connected = std::ssize(backend.workers) - lost;
  const auto leaving = std::ranges::count_if(
      backend.workers, [](const WorkerView& worker) { return worker.leaving && !worker.lost; });
  if (connected == 0) {
    std::string reason = "start some with `gauntlet-worker --dir DIR`";
    if (!backend.pool_trouble.empty()) {
      reason = backend.pool_trouble;
    } else if (!backend.allocations.empty()) {
      reason = fmt::format("{} allocations are starting or ending", backend.allocations.size());
    } else if (backend.own_workers > 0) {
      reason = fmt::format("{} of the master's own {} starting", backend.own_workers,
                           backend.own_workers == 1 ? "is" : "are");
    }
    return fmt::format("no worker is connected{}: {}{}",
                       lost > 0 ? fmt::format(" ({} {} silent now)", lost, lost == 1 ? "is" : "are") : "",
                       reason, TurnedAway(backend));
  }
  const auto quarantined = std::ranges::count_if(backend.workers, [](const WorkerView& worker) {
    return worker.record.quarantined && !worker.leaving && !worker.lost;
  });
  if (quarantined > 0 && quarantined + leaving == connected) {
    const auto first = std::ranges::find_if(
        backend.workers, [](const WorkerView& worker) { return worker.record.quarantined && !worker.lost; });
    return fmt::format("all {} connected workers are quarantined, of {}, {}: start others elsewhere",
                       connected, first->label, InWords(first->record));
  }
  if (leaving == connected) return fmt::format("all {} connected workers are leaving", connected);
  if (backend.queued == 0)
    return "all runs that were asked for are done; the master stores them and asks for more";
  return fmt::format("nothing is wrong, {} runs are just being given to {} workers", backend.queued,
                     connected - leaving - quarantined);
}

std::string StatusJson(const MasterView& master, const CampaignProgress& progress,
                       const BackendView& backend) {
  ordered_json workers = ordered_json::array();
  for (const WorkerView& worker : backend.workers) workers.push_back(Json(worker));
  ordered_json allocations = ordered_json::array();
  for (const AllocationView& allocation : backend.allocations) allocations.push_back(Json(allocation));
  return JsonText({{"state", master.stopping ? "stopping" : "running"},
                   {"campaign", master.campaign_id},
                   {"experiment", master.experiment},
                   {"master",
                    {{"host", master.host},
                     {"pid", master.pid},
                     {"epoch", master.epoch},
                     {"started_unix_ms", master.started_unix_ms},
                     {"endpoints", master.endpoints},
                     {"encrypted", master.encrypted},
                     {"batch_job", master.batch_job},
                     {"metrics", OrNull(master.metrics_url)}}},
                   {"unix_ms", master.now_unix_ms},
                   {"generation", progress.search.generation},
                   {"generations", progress.search.generations},
                   {"searches", progress.searches},
                   {"searches_finished", progress.searches_finished},
                   {"runs_done", progress.runs_done},
                   {"runs_planned", progress.runs_planned},
                   {"runs_running", RunsOf(backend, false)},
                   {"runs_ahead", RunsOf(backend, true)},
                   {"runs_queued", backend.queued},
                   {"runs_per_second", progress.runs_per_second},
                   {"remaining_seconds",
                    progress.remaining_seconds ? ordered_json(*progress.remaining_seconds) : nullptr},
                   {"total_failures", progress.total_failures},
                   {"runs_failed", progress.runs_failed},
                   {"workers", progress.workers.connected},
                   {"workers_busy", progress.workers.busy},
                   {"workers_lost", progress.workers.lost},
                   {"workers_quarantined", progress.workers.quarantined},
                   {"leased_again", progress.workers.releases},
                   {"duplicates", progress.workers.duplicates},
                   {"nondeterministic", master.nondeterministic_before + progress.workers.nondeterministic},
                   {"verdicts_of_one_worker", master.lone_verdicts_before + progress.workers.lone_verdicts},
                   {"copies", progress.workers.copies},
                   {"audits", progress.workers.audits},
                   {"audits_alone", progress.workers.audits_alone},
                   {"audits_waiting", progress.workers.audits_open},
                   {"worker_seconds", progress.workers.slot_seconds},
                   {"worker_seconds_idle", progress.workers.idle_seconds},
                   {"worker_seconds_at_barriers", progress.workers.barrier_seconds},
                   {"rejected_messages", progress.workers.rejected_messages},
                   {"workers_refused", backend.refused_workers},
                   {"connections_with_unknown_keys", backend.unknown_keys},
                   {"connections_dropped_in_the_greeting", backend.failed_handshakes},
                   {"why_nothing_runs", OrNull(WhyNothingRuns(master, progress, backend))},
                   {"pool_trouble", OrNull(backend.pool_trouble)},
                   {"allocations", std::move(allocations)},
                   {"worker_list", std::move(workers)}});
}

}  // namespace gauntlet
