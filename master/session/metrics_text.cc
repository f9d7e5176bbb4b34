#include "master/session/metrics_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/system/atomic_file.h"
#include "base/system/resource_limits.h"

namespace gauntlet {
namespace {

std::string EscapeLabel(std::string_view value) {
  std::string escaped;
  for (const char c : value) {
    if (c == '\\' || c == '"') escaped += '\\';
    if (c == '\n') {
      escaped += "\\n";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{}", value);
}

class Page {
 public:
  // `type`: "counter" or "gauge".
  void Describe(std::string_view name, std::string_view type, std::string_view help) {
    text_ += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
  }
  void Sample(std::string_view name, std::string_view labels, double value) {
    text_ += fmt::format("{}{} {}\n", name, labels, Number(value));
  }
  void Add(std::string_view name, std::string_view type, std::string_view help, auto value) {
    Describe(name, type, help);
    Sample(name, "", static_cast<double>(value));
  }
  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
};

void AddWorkers(Page& page, const BackendView& backend) {
  std::size_t leased = 0;
  for (const WorkerView& worker : backend.workers) leased += worker.leases.size();
  page.Describe("gauntlet_workers", "gauge", "Workers that the master knows, by what they do.");
  for (const std::string_view state : kWorkerStates) {
    page.Sample("gauntlet_workers", fmt::format("{{state=\"{}\"}}", state),
                static_cast<double>(std::ranges::count(backend.workers, state, StateOf)));
  }
  page.Add("gauntlet_runs_leased", "gauge", "Runs that workers have, those that wait there included.",
           leased);
  page.Add("gauntlet_runs_queued", "gauge", "Runs that wait for a worker.", backend.queued);
}

}  // namespace

ProcessCost CostOfThisProcess() {
  ProcessCost cost;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  cost.cpu_seconds = CpuSecondsOf(usage);
  // "size resident ...", in pages.
  if (const Result<std::string> statm = ReadSmallFile("/proc/self/statm"); statm) {
    const std::size_t space = statm->find(' ');
    if (space != std::string::npos) {
      cost.resident_bytes = std::strtoull(statm->c_str() + space, nullptr, 10) *
                            static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    }
  }
  return cost;
}

std::string MetricsText(const MasterView& master, const CampaignProgress& progress,
                        const BackendView& backend, const ProcessCost& cost) {
  const WorkerStatistics& workers = progress.workers;
  Page page;
  page.Describe("gauntlet_campaign_info", "gauge", "Always 1; which campaign this is.");
  page.Sample("gauntlet_campaign_info",
              fmt::format("{{campaign=\"{}\",experiment=\"{}\",host=\"{}\",epoch=\"{}\"}}",
                          EscapeLabel(master.campaign_id), EscapeLabel(master.experiment),
                          EscapeLabel(master.host), master.epoch),
              1);
  page.Add("gauntlet_runs_stored_total", "counter", "Runs whose result is stored, earlier masters included.",
           progress.runs_done);
  page.Add("gauntlet_runs_planned", "gauge", "Runs of the whole campaign; 0 = unknown.",
           progress.runs_planned);
  page.Add("gauntlet_runs_failed_total", "counter", "Stored runs without a result: crashed, hung, refused.",
           progress.runs_failed);
  page.Add("gauntlet_total_failures_total", "counter", "Stored runs in which the whole swarm failed.",
           progress.total_failures);
  page.Add("gauntlet_runs_per_second", "gauge", "Over the last seconds.", progress.runs_per_second);
  page.Add("gauntlet_generation", "gauge", "Generations that are complete, summed over the searches.",
           progress.search.generation);
  page.Add("gauntlet_generations", "gauge", "Generations that are planned, summed over the searches.",
           progress.search.generations);
  page.Add("gauntlet_best_fitness", "gauge", "Lowest fitness of the population (lower = tougher test case).",
           progress.best_fitness);
  page.Add("gauntlet_mean_fitness", "gauge", "Mean fitness of the population.", progress.mean_fitness);
  AddWorkers(page, backend);
  page.Add("gauntlet_workers_lost_total", "counter", "Workers that fell silent or died, since this start.",
           workers.lost);
  page.Add("gauntlet_runs_leased_again_total", "counter", "Leases whose worker was lost, since this start.",
           workers.releases);
  page.Add("gauntlet_duplicate_results_total", "counter", "Second results of a run, compared with the first.",
           workers.duplicates);
  page.Add("gauntlet_nondeterministic_results_total", "counter",
           "Second results that differed from the first, since the campaign began.",
           master.nondeterministic_before + workers.nondeterministic);
  page.Add(
      "gauntlet_verdicts_of_one_worker_total", "counter",
      "Runs given up on the word of a single worker, because there was no other, since the campaign began.",
      master.lone_verdicts_before + workers.lone_verdicts);
  page.Add("gauntlet_rejected_messages_total", "counter", "Messages and connections that were dropped.",
           workers.rejected_messages);
  page.Add("gauntlet_stopping", "gauge", "1 while the master lets the runs that have begun end.",
           master.stopping ? 1 : 0);
  page.Add("process_cpu_seconds_total", "counter", "CPU time of the master, s.", cost.cpu_seconds);
  page.Add("process_resident_memory_bytes", "gauge", "Resident memory of the master.", cost.resident_bytes);
  page.Add("process_start_time_seconds", "gauge", "When this master began, s since 1970.",
           static_cast<double>(master.started_unix_ms) / 1000.0);
  return page.Take();
}

}  // namespace gauntlet
