#include "master/campaign/campaign_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
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

// Who reads a field of status.json.
enum class Use {
  kNobody,  // of this program's own commands
  kRead,    // `status` and `watch`, when it is there
  kNeeded,  // likewise, and it has to be there
  kAdded,   // likewise, but `status` adds it: no master writes it
};

// One field of an object in status.json.
struct Field {
  const char* name;
  Use use;
  // What a master writes. Of one that has nothing to tell it also says which kind of value belongs there,
  // with null where there may be a text.
  ordered_json value;
  MetricSample metric = {};       // what it is as a metric, without the value; without a name when it is none
  std::vector<Field> parts = {};  // of an object, its fields; of a list, those of each of its objects
};

ordered_json ObjectOf(std::vector<Field> fields) {
  ordered_json object = ordered_json::object();
  for (Field& field : fields) {
    if (field.use != Use::kAdded) object[field.name] = std::move(field.value);
  }
  return object;
}

// A list with an object for each item.
template <class Item>
Field ListOf(const char* name, Use use, const std::vector<Item>& items,
             std::vector<Field> (*fields_of)(const Item&)) {
  ordered_json list = ordered_json::array();
  for (const Item& item : items) list.push_back(ObjectOf(fields_of(item)));
  return {name, use, std::move(list), {}, fields_of(Item{})};
}

std::vector<Field> FieldsOfLease(const WorkerView::Lease& lease) {
  return {{"run", Use::kNeeded, lease.run},
          {"lease", Use::kNobody, fmt::format("{:x}", lease.fence)},
          {"attempt", Use::kRead, lease.attempt},
          {"state", Use::kRead, lease.waits ? "waiting" : "running"},
          {"seconds", Use::kNeeded, lease.seconds}};
}

std::vector<Field> FieldsOfWorker(const WorkerView& worker) {
  const WorkerRecord& record = worker.record;
  return {{"worker", Use::kNeeded, worker.label},
          {"pid", Use::kNobody, worker.pid},
          {"slots", Use::kNobody, worker.slots},
          {"allocation", Use::kNobody, worker.allocation},
          {"state", Use::kNeeded, StateOf(worker)},
          {"silent_seconds", Use::kNeeded, worker.silent_seconds},
          {"runs_finished", Use::kNobody, record.finished},
          {"runs_failed", Use::kNobody, record.failed},
          {"failures_contradicted", Use::kNobody, record.contradicted},
          {"bad_answers", Use::kNobody, record.strikes},
          {"quarantined", Use::kRead, OrNull(record.quarantined ? InWords(record) : "")},
          ListOf("runs", Use::kNeeded, worker.leases, FieldsOfLease)};
}

std::vector<Field> FieldsOfAllocation(const AllocationView& allocation) {
  return {{"job", Use::kNeeded, allocation.job},
          {"role", Use::kAdded, ""},
          {"state", Use::kNeeded, allocation.state},
          {"reason", Use::kNeeded, allocation.reason},
          {"nodes", Use::kNeeded, allocation.nodes},
          {"workers", Use::kNeeded, allocation.workers},
          {"cancelled", Use::kNeeded, allocation.cancelled}};
}

std::vector<Field> FieldsOfMaster(const MasterView& master) {
  return {{"host", Use::kNeeded, master.host},
          {"pid", Use::kNeeded, master.pid},
          {"epoch", Use::kNeeded, master.epoch},
          {"started_unix_ms", Use::kNobody, master.started_unix_ms},
          {"endpoints", Use::kNobody, master.endpoints},
          {"encrypted", Use::kNeeded, master.encrypted},
          {"batch_job", Use::kNobody, master.batch_job},
          {"metrics", Use::kNobody, OrNull(master.metrics_url)}};
}

MetricSample Gauge(const char* name, const char* help, double value = 0.0, std::string labels = "") {
  return {name, "gauge", help, value, std::move(labels)};
}

MetricSample Counter(const char* name, const char* help) {
  return {name, "counter", help};
}

// What status.json tells of the campaign: its fields, in their order, up to the lists of jobs and workers.
std::vector<Field> FieldsOfCampaign(const MasterView& master, const CampaignProgress& progress,
                                    const BackendView& backend) {
  const WorkerStatistics& workers = progress.workers;
  return {
      {"state", Use::kNeeded, master.stopping ? "stopping" : "running"},
      {"campaign", Use::kNobody, master.campaign_id},
      {"experiment", Use::kNobody, master.experiment},
      {"master", Use::kRead, ObjectOf(FieldsOfMaster(master)), {}, FieldsOfMaster({})},
      {"unix_ms", Use::kRead, master.now_unix_ms},
      {"generation", Use::kRead, progress.search.generation,
       Gauge("gauntlet_generation", "Generations that are complete, summed over the searches.")},
      {"generations", Use::kRead, progress.search.generations,
       Gauge("gauntlet_generations", "Generations that are planned, summed over the searches.")},
      {"searches", Use::kNobody, progress.each.searches},
      {"searches_finished", Use::kNobody, progress.each.finished},
      {"searches_in_words", Use::kRead, progress.each.InWords()},
      {"runs_done", Use::kRead, progress.runs_done,
       Counter("gauntlet_runs_stored_total", "Runs whose result is stored, earlier masters included.")},
      {"runs_planned", Use::kNobody, progress.runs_planned,
       Gauge("gauntlet_runs_planned", "Runs of the whole campaign; 0 = unknown.")},
      {"runs_running", Use::kRead, RunsOf(backend, false)},
      {"runs_ahead", Use::kRead, RunsOf(backend, true)},
      {"runs_queued", Use::kRead, backend.queued,
       Gauge("gauntlet_runs_queued", "Runs that wait for a worker.")},
      {"runs_per_second", Use::kRead, progress.runs_per_second,
       Gauge("gauntlet_runs_per_second", "Over the last seconds.")},
      {"remaining_seconds", Use::kNobody,
       progress.remaining_seconds ? ordered_json(*progress.remaining_seconds) : nullptr},
      {"total_failures", Use::kNobody, progress.total_failures,
       Counter("gauntlet_total_failures_total", "Stored runs in which the whole swarm failed.")},
      {"runs_failed", Use::kNobody, progress.runs_failed,
       Counter("gauntlet_runs_failed_total", "Stored runs without a result: crashed, hung, refused.")},
      {"workers", Use::kNobody, workers.connected},
      {"workers_busy", Use::kNobody, workers.busy},
      {"workers_lost", Use::kNobody, workers.lost,
       Counter("gauntlet_workers_lost_total", "Workers that fell silent or died, since this start.")},
      {"workers_quarantined", Use::kNobody, workers.quarantined},
      {"leased_again", Use::kNobody, workers.releases,
       Counter("gauntlet_runs_leased_again_total", "Leases whose worker was lost, since this start.")},
      {"duplicates", Use::kNobody, workers.duplicates,
       Counter("gauntlet_duplicate_results_total", "Second results of a run, compared with the first.")},
      {"nondeterministic", Use::kRead, master.nondeterministic_before + workers.nondeterministic,
       Counter("gauntlet_nondeterministic_results_total",
               "Second results that differed from the first, since the campaign began.")},
      {"verdicts_of_one_worker", Use::kRead, master.lone_verdicts_before + workers.lone_verdicts,
       Counter("gauntlet_verdicts_of_one_worker_total",
               "Runs given up on the word of a single worker, because there was no other, since the campaign "
               "began.")},
      {"copies", Use::kNobody, workers.copies},
      {"audits", Use::kNobody, workers.audits},
      {"audits_alone", Use::kNobody, workers.audits_alone},
      {"audits_waiting", Use::kNobody, workers.audits_open},
      {"worker_seconds", Use::kNobody, workers.slot_seconds},
      {"worker_seconds_idle", Use::kNobody, workers.idle_seconds},
      {"worker_seconds_at_barriers", Use::kNobody, workers.barrier_seconds},
      {"rejected_messages", Use::kNobody, workers.rejected_messages,
       Counter("gauntlet_rejected_messages_total", "Messages and connections that were dropped.")},
      {"workers_refused", Use::kNobody, backend.refused_workers},
      {"connections_with_unknown_keys", Use::kNobody, backend.unknown_keys},
      {"connections_dropped_in_the_greeting", Use::kNobody, backend.failed_handshakes},
      {"why_nothing_runs", Use::kRead, OrNull(WhyNothingRuns(master, progress, backend))},
      {"pool_trouble", Use::kRead, OrNull(backend.pool_trouble)}};
}

constexpr std::size_t kListedWorkers = 200;

// Those about whom there is something to say come first.
std::vector<WorkerView> Listed(std::vector<WorkerView> workers) {
  const auto noteworthy = [](const WorkerView& one) { return one.lost || one.record.quarantined; };
  std::stable_partition(workers.begin(), workers.end(), noteworthy);
  workers.resize(std::min(workers.size(), kListedWorkers));
  return workers;
}

// How many others there are in each state.
std::vector<Field> FieldsOfUnlisted(const std::vector<WorkerView>& all,
                                    const std::vector<WorkerView>& listed) {
  std::vector<Field> fields;
  for (const std::string_view state : kWorkerStates) {
    const auto is = [state](const WorkerView& one) { return StateOf(one) == state; };
    fields.push_back(
        {state.data(), Use::kRead, std::ranges::count_if(all, is) - std::ranges::count_if(listed, is)});
  }
  return fields;
}

std::vector<Field> AllFields(const MasterView& master, const CampaignProgress& progress,
                             const BackendView& backend) {
  std::vector<Field> fields = FieldsOfCampaign(master, progress, backend);
  fields.push_back(ListOf("allocations", Use::kRead, backend.allocations, FieldsOfAllocation));
  const std::vector<WorkerView> listed = Listed(backend.workers);
  fields.push_back(ListOf("worker_list", Use::kNeeded, listed, FieldsOfWorker));
  const std::vector<Field> unlisted = FieldsOfUnlisted(backend.workers, listed);
  fields.push_back({"workers_not_listed", Use::kRead, ObjectOf(unlisted), {}, unlisted});
  return fields;
}

// Whoever adds two counts must not overflow.
constexpr std::uint64_t kMostCounted = 1ULL << 62;

// What belongs where a master that has nothing to tell writes `sample`; "" when `value` is that.
std::string_view Demanded(const ordered_json& sample, const ordered_json& value) {
  const auto unless = [](bool fits, std::string_view words) { return fits ? "" : words; };
  if (sample.is_string()) return unless(value.is_string(), "a text");
  if (sample.is_null()) return unless(value.is_string() || value.is_null(), "a text or null");
  if (sample.is_number_float()) return unless(value.is_number(), "a number");
  if (sample.is_boolean()) return unless(value.is_boolean(), "true or false");
  if (sample.is_object()) return unless(value.is_object() || value.is_null(), "an object or null");
  if (sample.is_array()) return unless(value.is_array(), "a list");
  return unless(value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostCounted, "a count");
}

// `place`: of the object, "" of the whole.
Status CheckFields(const ordered_json& object, const std::vector<Field>& fields, const std::string& place) {
  if (!object.is_object()) return Error{ErrorKind::kCorrupt, fmt::format("{} is no object", place)};
  for (const Field& field : fields) {
    const auto found = object.find(field.name);
    if (field.use == Use::kNobody || (found == object.end() && field.use != Use::kNeeded)) continue;
    const std::string at = fmt::format("{}{}{}", place, place.empty() ? "" : ".", field.name);
    const ordered_json& value =
        found == object.end() ? ordered_json(ordered_json::value_t::discarded) : *found;
    if (const std::string_view demanded = Demanded(field.value, value); !demanded.empty()) {
      return Error{ErrorKind::kCorrupt,
                   fmt::format("{} is {}, where {} belongs", at,
                               value.is_discarded() ? "missing" : value.type_name(), demanded)};
    }
    if (field.value.is_object() && value.is_object()) {
      TRY(CheckFields(value, field.parts, at));
    }
    for (std::size_t i = 0; field.value.is_array() && i < value.size(); ++i) {
      TRY(CheckFields(value[i], field.parts, fmt::format("{}[{}]", at, i)));
    }
  }
  return Ok{};
}

std::string Labelled(std::string_view label, std::string_view value) {
  std::string text = fmt::format("{}=\"", label);
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    text += c == '\n' ? std::string_view("\\n") : std::string_view(&c, 1);
  }
  return text + '"';
}

}  // namespace

void SearchesProgress::Add(const SearchProgress& one) {
  ++searches;
  if (one.finished) ++finished;
  if (one.finished && searches > 1) return;
  const bool first = searches - finished <= 1;
  slowest = first ? one.generation : std::min(slowest, one.generation);
  fastest = first ? one.generation : std::max(fastest, one.generation);
  planned = std::max(planned, one.generations);
}

std::string SearchesProgress::InWords() const {
  if (searches <= 1) return planned > 1 ? fmt::format("generation {}/{}", slowest, planned) : "";
  if (finished == searches) return fmt::format("{} searches finished", searches);
  std::string words = fmt::format("{} of {} searches finished", finished, searches);
  if (planned <= 1) return words;
  const std::string range =
      slowest == fastest ? fmt::format("{}", slowest) : fmt::format("{} to {}", slowest, fastest);
  return fmt::format("{}, {} in generation {} of {}", words, finished == 0 ? "all" : "the others", range,
                     planned);
}

std::string WhyNothingRuns(const MasterView& master, const CampaignProgress& progress,
                           const BackendView& backend) {
  if (RunsOf(backend, false) > 0) return "";
  if (progress.search.finished) return "the campaign has finished";
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
  return JsonText(ObjectOf(AllFields(master, progress, backend)));
}

Status CheckStatus(const ordered_json& status) {
  std::vector<Field> fields = AllFields({}, {}, {});
  // A master without workers tells why nothing runs.
  std::ranges::find(fields, std::string_view("why_nothing_runs"), &Field::name)->value = nullptr;
  return CheckFields(status, fields, "");
}

std::vector<MetricSample> StatusMetrics(const MasterView& master, const CampaignProgress& progress,
                                        const BackendView& backend) {
  std::vector<MetricSample> metrics = {Gauge(
      "gauntlet_campaign_info", "Always 1; which campaign this is.", 1,
      fmt::format("{},{},{},epoch=\"{}\"", Labelled("campaign", master.campaign_id),
                  Labelled("experiment", master.experiment), Labelled("host", master.host), master.epoch))};
  for (Field& field : FieldsOfCampaign(master, progress, backend)) {
    if (field.metric.name == nullptr) continue;
    field.metric.value = field.value.get<double>();
    metrics.push_back(std::move(field.metric));
  }
  for (const std::string_view state : kWorkerStates) {
    const auto workers = std::ranges::count(backend.workers, state, StateOf);
    metrics.push_back(Gauge("gauntlet_workers", "Workers that the master knows, by what they do.",
                            static_cast<double>(workers), Labelled("state", state)));
  }
  const std::uint64_t leased = RunsOf(backend, false) + RunsOf(backend, true);
  metrics.insert(
      metrics.end(),
      {Gauge("gauntlet_runs_leased", "Runs that workers have, those that wait there included.",
             static_cast<double>(leased)),
       Gauge("gauntlet_best_fitness", "Lowest fitness of the population (lower = tougher test case).",
             progress.best_fitness),
       Gauge("gauntlet_mean_fitness", "Mean fitness of the population.", progress.mean_fitness),
       Gauge("gauntlet_stopping", "1 while the master lets the runs that have begun end.",
             master.stopping ? 1 : 0),
       Gauge("process_start_time_seconds", "When this master began, s since 1970.",
             static_cast<double>(master.started_unix_ms) / 1000.0)});
  return metrics;
}

}  // namespace gauntlet
