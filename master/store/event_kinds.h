// What can happen to a campaign, as the table events and the log name it (StoredEvent::kind,
// DispatchEvent::kind).
#pragma once

namespace gauntlet::event {

// Of a session of the master.
inline constexpr const char* kStart = "start";
inline constexpr const char* kResume = "resume";
inline constexpr const char* kExtended = "extended";  // its searches go on for longer than they were to
inline constexpr const char* kCopied = "copied";      // the directory is a copy of another campaign's
inline constexpr const char* kAudit = "audit";        // how many runs were simulated twice, and compared
inline constexpr const char* kStop = "stop";
inline constexpr const char* kFinished = "finished";

// Of workers.
inline constexpr const char* kWorkerJoined = "worker-joined";
inline constexpr const char* kWorkerRefused = "worker-refused";
inline constexpr const char* kWorkerLost = "worker-lost";
inline constexpr const char* kWorkerBack = "worker-back";
inline constexpr const char* kWorkerLeft = "worker-left";
inline constexpr const char* kWorkerQuarantined = "worker-quarantined";  // gets nothing more to do
inline constexpr const char* kWorkerDied = "worker-died";
inline constexpr const char* kWorkerNotStarted = "worker-not-started";
inline constexpr const char* kSlurm = "slurm";  // what the batch system was asked for, or answered
inline constexpr const char* kRejectedMessage = "rejected-message";

// Of runs.
inline constexpr const char* kRunnerFailure = "runner-failure";        // a run failed of itself
inline constexpr const char* kRunReturned = "run-returned";            // a worker gave it back
inline constexpr const char* kRunGivenUp = "run-given-up";             // failed in every attempt
inline constexpr const char* kRunGivenUpAlone = "run-given-up-alone";  // likewise, all on one worker
inline constexpr const char* kNondeterministic = "nondeterministic";
// Of a program of the user's, what was observed (master/campaign/observed_reproducibility.h reads it).
inline constexpr const char* kReproducible = "reproducible";
inline constexpr const char* kNotReproducible = "not-reproducible";

}  // namespace gauntlet::event
