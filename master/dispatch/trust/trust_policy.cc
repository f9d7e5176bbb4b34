#include "master/dispatch/trust/trust_policy.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "base/hash.h"

namespace gauntlet {
namespace {

auto Told(const proto::RunnerFailure& failure) {
  return std::tuple(failure.kind, failure.signal, failure.exit_code);
}

constexpr std::chrono::seconds kFirstWait{1};      // after an end from outside; doubled by each further one
constexpr std::chrono::seconds kTimeToGoAway{30};  // so long after it a worker may say that it ends

bool FromOutside(const std::optional<proto::RunnerFailure>& failure) {
  return failure && failure->kind == proto::FailureKind::kExternal;
}

bool QuarantineIfDue(WorkerRecord& record) {
  if (!record.deserves_quarantine()) return false;
  return record.quarantined = true;
}

}  // namespace

const TrustPolicy::Case& TrustPolicy::CaseOf(RunId run) const {
  static const Case none;
  const auto found = cases_.find(run);
  return found == cases_.end() ? none : found->second;
}

bool TrustPolicy::FailedOn(const Case& attempts, InstanceId worker) {
  return std::ranges::count(attempts, worker, &Attempt::worker) > 0;
}

bool TrustPolicy::Trusted(const Attempt& attempt) const {
  const auto found = witnesses_.find(attempt.worker);
  return found == witnesses_.end() ? attempt.trusted : found->second.record.trusted();
}

void TrustPolicy::Meet(InstanceId worker, const std::string& host) {
  const auto [witness, is_new] = witnesses_.try_emplace(worker);
  witness->second.host = host;
  if (is_new) witness->second.all_before = all_;
}

const std::string& TrustPolicy::HostOf(InstanceId worker) const {
  static const std::string unknown;
  const auto found = witnesses_.find(worker);
  return found == witnesses_.end() ? unknown : found->second.host;
}

TrustPolicy::Workers TrustPolicy::Finished(InstanceId worker, RunId run) {
  const auto ended = cases_.extract(run);
  const auto found = witnesses_.find(worker);
  if (found == witnesses_.end() || found->second.record.quarantined) return {};
  somebody_finished_ = true;
  ++found->second.record.finished;
  found->second.record.failed_in_a_row = 0;
  found->second.record.returned = 0;
  found->second.record.hoarded = 0;
  ++all_.finished;
  found->second.failed_since = 0;
  found->second.all_before = all_;
  if (ended.empty()) return {};
  Workers quarantined;
  std::set<InstanceId> seen{worker};
  for (const Attempt& attempt : ended.mapped()) {
    const auto wrong = witnesses_.find(attempt.worker);
    if (!attempt.failure || wrong == witnesses_.end() || !seen.insert(attempt.worker).second) continue;
    WorkerRecord& record = wrong->second.record;
    ++(FromOutside(attempt.failure) ? record.outside : record.contradicted);
    if (QuarantineIfDue(record)) quarantined.push_back(attempt.worker);
  }
  return quarantined;
}

bool TrustPolicy::Failed(InstanceId worker, RunId run, std::optional<proto::RunnerFailure> failure,
                         Duration now) {
  Witness& witness = witnesses_.at(worker);
  WorkerRecord& record = witness.record;
  Case& attempts = cases_[run];
  const bool again = FailedOn(attempts, worker);
  const bool own = failure.has_value();
  attempts.push_back({worker, witness.host, record.trusted(), now, std::move(failure)});
  unjudged_.push_back(run);
  if (!own) return false;
  record.returned = 0;
  record.hoarded = 0;
  if (!first_failure_) first_failure_ = now;
  ++record.failed;
  if (!again) ++record.failed_in_a_row;
  ++all_.failed;
  ++witness.failed_since;
  if (FailsAlone(witness)) {
    record.failed_alone = witness.failed_since;
    return QuarantineIfDue(record);
  }
  if (PictureOf(attempts, {}).workers <= 1) return false;
  // It is the run, as it seems: nobody looks like a black hole for it.
  for (const Attempt& attempt : attempts) {
    if (const auto known = witnesses_.find(attempt.worker); known != witnesses_.end() && attempt.failure)
      known->second.record.failed_in_a_row = 0;
  }
  return false;
}

// Its runs fail one after the other, and of those that others had meanwhile at most one in so many.
bool TrustPolicy::FailsAlone(const Witness& witness) const {
  if (!reproducibility_.first_ending_counts() || witness.failed_since < WorkerRecord::kMostInARow)
    return false;
  const std::uint64_t finished = all_.finished - witness.all_before.finished;
  const std::uint64_t failed = all_.failed - witness.all_before.failed - witness.failed_since;
  return finished >= WorkerRecord::kFinishedForEachFault * (1 + failed);
}

bool TrustPolicy::Strike(InstanceId worker) {
  const auto found = witnesses_.find(worker);
  if (found == witnesses_.end()) return false;
  ++found->second.record.strikes;
  return QuarantineIfDue(found->second.record);
}

bool TrustPolicy::Returned(InstanceId worker) {
  WorkerRecord& record = witnesses_.at(worker).record;
  ++record.returned;
  return QuarantineIfDue(record);
}

bool TrustPolicy::Hoarded(InstanceId worker) {
  WorkerRecord& record = witnesses_.at(worker).record;
  ++record.hoarded;
  return QuarantineIfDue(record);
}

bool TrustPolicy::Erase(RunId run, const std::function<bool(const Attempt&)>& which) {
  const auto found = cases_.find(run);
  if (found == cases_.end() || std::erase_if(found->second, which) == 0) return false;
  unjudged_.push_back(run);
  if (found->second.empty()) cases_.erase(found);
  return true;
}

bool TrustPolicy::Disregard(InstanceId worker, RunId run) {
  return Erase(run, [&](const Attempt& attempt) { return attempt.worker == worker; });
}

bool TrustPolicy::Excuse(InstanceId worker, RunId run, Duration now) {
  return Erase(run, [&](const Attempt& attempt) {
    return attempt.worker == worker && FromOutside(attempt.failure) && now - attempt.when < kTimeToGoAway;
  });
}

bool TrustPolicy::Waits(RunId run, Duration now) const {
  Duration wait{};
  Duration last{};
  for (const Attempt& attempt : CaseOf(run)) {
    if (!FromOutside(attempt.failure)) continue;
    wait = wait == Duration::zero() ? Duration(kFirstWait) : 2 * wait;
    last = attempt.when;
  }
  return wait > Duration::zero() && now - last < wait;
}

bool TrustPolicy::Audits(RunId run) const {
  if (!(options_.audit_share > 0.0)) return false;
  Fnv1a64 hash;
  hash.AddUint64(run);
  return static_cast<double>(hash.value() >> 11) * 0x1p-53 < options_.audit_share;
}

bool TrustPolicy::PatienceLasts(Duration now) const {
  return !somebody_finished_ && (!first_failure_ || now - *first_failure_ < options_.patience);
}

TrustPolicy::Picture TrustPolicy::PictureOf(const Case& attempts, const Workers& others) const {
  Picture picture;
  Workers seen;
  for (const Attempt& attempt : attempts) {
    if (!attempt.failure) continue;
    if (picture.failures++ == 0) {
      picture.only_host = attempt.host;
    } else if (picture.only_host != attempt.host) {
      picture.only_host.reset();
    }
    if (std::ranges::count(seen, attempt.worker) > 0) continue;
    seen.push_back(attempt.worker);
    ++picture.workers;
    if (Trusted(attempt)) ++picture.trusted;
  }
  for (const InstanceId worker : others) {
    if (FailedOn(attempts, worker)) continue;
    const Witness& witness = witnesses_.at(worker);
    ++picture.unasked;
    if (!witness.record.tried()) ++picture.untried;
    if (picture.only_host && witness.host != *picture.only_host) picture.elsewhere = true;
  }
  return picture;
}

bool TrustPolicy::Condemned(const Picture& picture, bool more_to_do, Duration now) const {
  if (picture.failures < options_.attempts || PatienceLasts(now)) return false;
  // With other work to do, one of those that failed it may still show that it can be trusted.
  if (picture.unasked == 0) return picture.trusted > 0 || !somebody_finished_ || !more_to_do;
  if (picture.elsewhere) return false;
  if (somebody_finished_) return picture.trusted >= options_.attempts;
  return picture.untried == 0 && picture.workers >= options_.attempts;
}

const TrustPolicy::Attempt* TrustPolicy::FirstEnding(const Case& attempts) const {
  if (!reproducibility_.first_ending_counts()) return nullptr;
  const auto ended = std::ranges::find_if(attempts, [this](const Attempt& attempt) {
    const auto known = witnesses_.find(attempt.worker);
    const bool believed = known == witnesses_.end() || !known->second.record.quarantined;
    return believed && attempt.failure && !FromOutside(attempt.failure);
  });
  return ended == attempts.end() ? nullptr : &*ended;
}

std::optional<Verdict> TrustPolicy::Judge(RunId run, const Workers& others, bool more_to_do,
                                          Duration now) const {
  const Case& attempts = CaseOf(run);
  if (const Attempt* first = FirstEnding(attempts); first != nullptr)
    return Verdict{first->worker, *first->failure, 1, 1, 1, /*first_ending=*/true};
  const Picture picture = PictureOf(attempts, others);
  if (Waits(run, now) || !Condemned(picture, more_to_do, now)) return std::nullopt;
  // What is told most often, by trusted workers if there are any: it must not depend on who else is there.
  const auto counts = [&](const Attempt& attempt) {
    return attempt.failure && (picture.trusted == 0 || Trusted(attempt));
  };
  const Attempt* verdict = nullptr;
  std::uint32_t most = 0;
  for (const Attempt& attempt : attempts) {
    if (!counts(attempt)) continue;
    const auto alike = static_cast<std::uint32_t>(std::ranges::count_if(attempts, [&](const Attempt& other) {
      return counts(other) && Told(*other.failure) == Told(*attempt.failure);
    }));
    if (verdict == nullptr || alike > most ||
        (alike == most && Told(*attempt.failure) <= Told(*verdict->failure))) {
      verdict = &attempt;
      most = alike;
    }
  }
  return Verdict{verdict->worker, *verdict->failure, most, picture.failures, picture.workers};
}

std::optional<InstanceId> TrustPolicy::NextFor(RunId run, const Workers& free, const Workers& others,
                                               bool more_to_do) const {
  const Case& attempts = CaseOf(run);
  const Picture picture = PictureOf(attempts, others);
  const bool enough = picture.failures >= options_.attempts;
  if (enough && picture.unasked == 0) return std::nullopt;  // it waits to be judged
  std::optional<InstanceId> best;
  std::pair<bool, std::ptrdiff_t> best_rank;
  for (const InstanceId worker : free) {
    const Witness& witness = witnesses_.at(worker);
    if (picture.unasked > 0) {
      if (FailedOn(attempts, worker) || (picture.elsewhere && witness.host == *picture.only_host)) continue;
      // Whom nobody trusts yet can say little, and may earn trust meanwhile. Where nobody has finished
      // anything, those who have failed something have said enough.
      const bool said_enough =
          !somebody_finished_ && witness.record.tried() && picture.workers >= options_.attempts;
      if (enough && !witness.record.trusted() && (more_to_do || said_enough)) continue;
    }
    // Trusted ones first, then those that have tried it least often.
    const std::pair rank{witness.record.trusted(), -std::ranges::count(attempts, worker, &Attempt::worker)};
    if (best && rank <= best_rank) continue;
    best = worker;
    best_rank = rank;
  }
  return best;
}

std::optional<InstanceId> TrustPolicy::HelperFor(RunId run, const Workers& free) const {
  const Case& attempts = CaseOf(run);
  const bool enough = PictureOf(attempts, {}).failures >= options_.attempts;
  std::optional<InstanceId> best;
  std::pair<bool, bool> best_rank;
  for (const InstanceId worker : free) {
    const bool failed = FailedOn(attempts, worker);
    if (failed && enough) continue;
    const std::pair rank{!failed, witnesses_.at(worker).record.trusted()};
    if (best && rank <= best_rank) continue;
    best = worker;
    best_rank = rank;
  }
  return best;
}

}  // namespace gauntlet
