// What a campaign does right now: what runs where, since when, and why nothing runs. The living master says
// it in status.json; this is the only way to know, because nobody else reads the database meanwhile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/dispatch/evaluation_backend.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// How far the searches of a campaign have come, each for itself.
struct SearchesProgress {
  std::size_t searches = 0;
  std::size_t finished = 0;
  // Of those that have not finished (of an only search in any case).
  std::uint32_t slowest = 0;  // generation
  std::uint32_t fastest = 0;
  std::uint32_t planned = 0;  // generations, the most of any

  void Add(const SearchProgress& one);
  // "generation 12/50"; "3 of 10 searches finished, the others in generation 12 to 14 of 50"; "" of an only
  // search without generations.
  std::string InWords() const;
};

// How far a campaign that is being served has come. Of several searches, generations and counts are sums.
struct CampaignProgress {
  SearchProgress search;
  SearchesProgress each;
  std::uint64_t runs_done = 0;     // stored, earlier sessions included
  std::uint64_t runs_planned = 0;  // 0 = unknown
  double runs_per_second = 0.0;    // over the last seconds
  double best_fitness = 0.0;       // of the population at the last complete generation; NaN before the first
  double mean_fitness = 0.0;       // of several searches: the mean over them
  std::uint64_t total_failures = 0;  // runs so far
  std::uint64_t runs_failed = 0;     // verdict other than completed
  WorkerStatistics workers;
  std::optional<double> remaining_seconds;  // at the present rate
};

// Several searches are as far as they are together, and have finished when all have.
inline void Add(const SearchProgress& one, SearchProgress& sum) {
  sum.generation += one.generation;
  sum.generations += one.generations;
  sum.evaluations_done += one.evaluations_done;
  sum.evaluations_planned += one.evaluations_planned;
  sum.individuals_planned += one.individuals_planned;
  sum.finished = sum.finished && one.finished;
}

enum class CampaignEnd { kFinished, kStopped };

struct MasterView {
  std::string campaign_id;
  std::string experiment;
  std::string host;
  std::int64_t pid = 0;
  std::uint64_t epoch = 0;
  std::int64_t started_unix_ms = 0;
  std::int64_t now_unix_ms = 0;
  std::vector<std::string> endpoints;
  bool encrypted = false;
  std::string batch_job;                      // that it is, "" = none
  std::string metrics_url = "";               // "" = none
  std::uint64_t nondeterministic_before = 0;  // results that differed, under former masters
  std::uint64_t lone_verdicts_before = 0;     // verdicts on the word of one worker, likewise
  bool stopping = false;                      // lets the runs that have begun end
};

// The document of status.json, README section "Status".
std::string StatusJson(const MasterView& master, const CampaignProgress& progress,
                       const BackendView& backend);

// One sample for a monitoring system, by the words of Prometheus' text format.
struct MetricSample {
  const char* name = nullptr;  // "gauntlet_runs_queued"
  const char* type = "";       // "counter" or "gauge"
  const char* help = "";
  double value = 0.0;
  std::string labels = "";  // "state=\"idle\"", "" for none
};
// Those of the campaign, which stand in docs/operations.md; samples of one name follow each other.
std::vector<MetricSample> StatusMetrics(const MasterView& master, const CampaignProgress& progress,
                                        const BackendView& backend);

// kCorrupt when what `status` and `watch` read of such a document is missing or is of another type: it names
// the place, "worker_list[2].runs". Anybody may have written what claims to be one.
Status CheckStatus(const nlohmann::ordered_json& status);

// One sentence why no run is simulated at this moment; "" while some are.
std::string WhyNothingRuns(const MasterView& master, const CampaignProgress& progress,
                           const BackendView& backend);

}  // namespace gauntlet
