// Who is believed when runs fail, and who gets nothing more to do. It is told what workers say of runs, and
// answers; what becomes of leases and runs is the scheduler's business (master/dispatch/leases).
//
// A run that fails on every worker is at fault itself, one that fails on a single worker among many is not.
// So each failed attempt is remembered with its worker, and the run goes to others. It is given up
//   - when `attempts` workers that have shown that they can work have failed it, not all of them on one host
//     while there are others;
//   - or when nobody is left to ask, after `attempts` attempts on those there are;
//   - and while no run at all has been finished, only after some patience, once every worker has had a run: a
//     bad worker may be the first to say hello.
// An end from outside (a signal that the run's process did not send to itself) is such a failure too, when
// its worker lives on: a run that always ends so would otherwise be tried for ever. The run waits after each,
// longer each time, and a worker that drains or goes away meanwhile has said nothing.
//
// All this takes a run for a pure function. Of a program that is not known to be one (reproducibility.h) a
// run's own first ending counts, and what is held against a worker is that only its runs fail.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/trust/reproducibility.h"
#include "master/dispatch/trust/worker_record.h"
#include "proto/messages.h"

namespace gauntlet {

using proto::InstanceId;
using proto::RunId;

// How a run is said to have failed in the end.
struct Verdict {
  InstanceId worker = 0;         // of the failure that is the verdict
  proto::RunnerFailure failure;  // the last of those that are told alike and most often
  std::uint32_t alike = 0;       // how many these were
  std::uint32_t attempts = 0;    // failures of all sorts
  std::uint32_t workers = 0;     // on which it failed; 1: there was no other to ask
  bool first_ending = false;     // which counts, and nobody else was asked

  bool alone() const { return workers == 1 && !first_ending; }  // because there was nobody else
};

struct TrustOptions {
  std::uint32_t attempts = 3;  // failures that make a verdict
  Duration patience{};         // since the first failure, while no run has been finished
  double audit_share = 0.0;    // of runs that are simulated once more, 0 to 1
  Reproducible reproducible = Reproducible::kPromised;  // as is known so far
};

// Workers are known from Meet to Forget. Times are those of one clock, which begins anywhere.
class TrustPolicy {
 public:
  using Workers = std::vector<InstanceId>;

  explicit TrustPolicy(const TrustOptions& options)
      : options_(options), reproducibility_(options.reproducible) {}

  Reproducibility& reproducibility() { return reproducibility_; }
  const Reproducibility& reproducibility() const { return reproducibility_; }

  // Keeps the record of one that is known.
  void Meet(InstanceId worker, const std::string& host);
  void Forget(InstanceId worker) { witnesses_.erase(worker); }
  const WorkerRecord& RecordOf(InstanceId worker) const { return witnesses_.at(worker).record; }
  const std::string& HostOf(InstanceId worker) const;  // "" when nobody knows

  // The worker brought the run's result: those who failed the run were wrong, unless it is quarantined itself
  // or unknown. Answers with those who are quarantined for it.
  Workers Finished(InstanceId worker, RunId run);
  // The run failed on this worker, which is known; without a failure: its answer could not be read. Of kind
  // kExternal it names the signal. True: the worker is quarantined for it.
  bool Failed(InstanceId worker, RunId run, std::optional<proto::RunnerFailure> failure, Duration now);
  // It said what it cannot know, or what nobody can read. True: it is quarantined for it.
  bool Strike(InstanceId worker);
  // It gave a lease back without having begun it. True: it is quarantined for it.
  bool Returned(InstanceId worker);
  // It kept a run unusually long, and another worker has finished it. True: it is quarantined for it.
  bool Hoarded(InstanceId worker);
  // What it said of the run does not count. False: it has said nothing.
  bool Disregard(InstanceId worker, RunId run);
  // The worker goes away: what has just ended from outside on it has probably ended for that. The same.
  bool Excuse(InstanceId worker, RunId run, Duration now);
  // It was ended from outside, and is not yet tried again.
  bool Waits(RunId run, Duration now) const;
  // The run has ended with its verdict.
  void Close(RunId run) { cases_.erase(run); }

  // Has it failed, and neither finished nor ended with a verdict?
  bool InDoubt(RunId run) const { return cases_.contains(run); }
  // No run has been finished, and more workers may come.
  bool PatienceLasts(Duration now) const;

  // Runs of whose failures something new is known since the last call, in its order.
  std::vector<RunId> TakeUnjudged() { return std::exchange(unjudged_, {}); }
  // Is this run, when it has finished, to be simulated by another worker too? The same runs in every session
  // and for any number of workers.
  bool Audits(RunId run) const;

  // `others`: who could be asked for the run at all; `more_to_do`: runs that nobody has failed wait.
  std::optional<Verdict> Judge(RunId run, const Workers& others, bool more_to_do, Duration now) const;
  // Who of `free`, the first of equals, is to try a run that is in doubt: those that have not failed it
  // first, even if they are busy now and it waits for them; on another host first.
  std::optional<InstanceId> NextFor(RunId run, const Workers& free, const Workers& others,
                                    bool more_to_do) const;
  // Who of `free`, the first of equals, is to do a run that another one has: one that is known to bring
  // results, if there is one, and rather none that has failed the run.
  std::optional<InstanceId> HelperFor(RunId run, const Workers& free) const;

 private:
  struct Tally {  // of runs
    std::uint64_t finished = 0;
    std::uint64_t failed = 0;
  };
  struct Witness {
    std::string host;
    WorkerRecord record;
    std::uint64_t failed_since = 0;  // it last finished a run
    Tally all_before = {};           // of all workers, then
  };
  struct Attempt {
    InstanceId worker = 0;
    std::string host;
    bool trusted = false;  // the worker, then
    Duration when{};
    std::optional<proto::RunnerFailure> failure;  // none: the answer could not be read
  };
  using Case = std::vector<Attempt>;
  struct Picture {                         // of a run that has failed
    std::uint32_t failures = 0;            // that count
    std::uint32_t workers = 0;             // different ones on which it failed
    std::uint32_t trusted = 0;             // of these
    std::optional<std::string> only_host;  // all were there; none: on several
    std::uint32_t unasked = 0;             // others, that have not failed it
    std::uint32_t untried = 0;             // of these, that have neither finished nor failed anything yet
    bool elsewhere = false;                // some of these are on another host than all that failed it
  };

  const Case& CaseOf(RunId run) const;
  static bool FailedOn(const Case& attempts, InstanceId worker);
  bool Erase(RunId run, const std::function<bool(const Attempt&)>& which);
  bool Trusted(const Attempt& attempt) const;
  Picture PictureOf(const Case& attempts, const Workers& others) const;
  bool Condemned(const Picture& picture, bool more_to_do, Duration now) const;
  // That is the run's verdict; nullptr: there is none, or it does not count.
  const Attempt* FirstEnding(const Case& attempts) const;
  bool FailsAlone(const Witness& witness) const;

  TrustOptions options_;
  Reproducibility reproducibility_;
  std::map<InstanceId, Witness> witnesses_;
  std::unordered_map<RunId, Case> cases_;  // of runs that have failed and are unfinished
  std::vector<RunId> unjudged_;            // of these, about which something new is known
  bool somebody_finished_ = false;         // a run, for this master
  Tally all_;
  std::optional<Duration> first_failure_;
};

}  // namespace gauntlet
