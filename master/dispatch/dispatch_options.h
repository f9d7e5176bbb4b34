// What a campaign decides about leases, limits and retries.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "master/dispatch/trust/reproducibility.h"
#include "proto/golden_hashes.h"

namespace gauntlet {

struct DispatchOptions {
  std::chrono::milliseconds heartbeat{1000};  // both ways
  int lost_after = 3;  // heartbeats of silence after which a worker's runs go elsewhere
  // A run that fails of itself (crash, hang, memory) this often gets the verdict; lost workers and signals
  // from outside are no attempts.
  std::uint32_t attempts = 3;
  // Leases per slot, at least. 1: one run at a time. 2: the next run is already there when a slot becomes
  // free, so that a run of some milliseconds never waits for a round trip.
  std::uint32_t credit = 2;
  // Runs shorter than this are leased ahead, until about so much work waits at each slot (at most most_credit
  // runs): round trips and commits then cost many of them at once.
  std::chrono::milliseconds work_ahead{10};
  std::uint32_t most_credit = 256;
  // While at least so many runs wait unleased for each slot, no search waits for a single result: up to this
  // much work is leased ahead then, but never more than waits, and results may come together.
  std::uint32_t many_waiting = 8;
  std::chrono::milliseconds most_work_ahead{1000};
  std::chrono::milliseconds result_wait{500};  // proto::Lease::result_wait
  // When no run waits, an idle worker gets a copy of a run that has taken this many times the predicted time
  // on another; the first answer counts. 0 = never.
  double copy_after = 2.0;
  // Of the campaign's runs, as is known so far.
  Reproducible reproducible = Reproducible::kPromised;
  // Leases that the workers of one host have at once, together; 0 = as many as they have slots for.
  int most_per_host = 0;
  int cores_per_run = 1;  // that a run takes of its host: so many slots there are busy with it
  bool LimitsHosts() const { return most_per_host > 0 || cores_per_run > 1; }
  // Share of runs, 0 to 1, that another worker simulates once more, to be compared.
  double audit_share = 0.0;
  // CPU time of one runner on one run, s; only there to end what would never end. Campaigns give more for
  // long runs (run_limits.h).
  double cpu_limit_seconds = 60.0;
  std::uint64_t memory_limit_bytes = 2ULL << 30;  // address space of one runner; 0 = no limit
  // Workers leave out the robots' waypoints and the annotations, which are most of a result's bytes.
  bool without_ways = false;
  // How long a vanished worker is remembered: its late results are still taken. Longer than the time for
  // which workers look for a lost master (10 min).
  std::chrono::milliseconds forget_after{15 * 60 * 1000};
};

// What worker and master must agree on before a worker gets a lease.
struct CampaignIdentity {
  std::string campaign_id;
  std::uint64_t epoch = 1;  // number of this master start; must fit 32 bits: it begins the fencing numbers
  std::string software_version;       // which may be another one; told to those who speak another protocol
  proto::GoldenHashes golden_hashes;  // of the controllers that the campaign uses
};

}  // namespace gauntlet
