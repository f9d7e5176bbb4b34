// What a backend tells people: events, messages that were dropped, workers that were turned away. Whatever
// strangers send, it stays short.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/evaluation_backend.h"

namespace gauntlet {

// The end of a text that came from a worker, fit for a line of a log or a terminal.
std::string Shorten(std::string_view text);

class DispatchLog {
 public:
  // An event (master/store/event_kinds.h); its text is made fit for one line.
  void Report(std::string kind, std::string_view text);
  // An attempt at a run failed, in this sense of the word: "was ended from outside by signal 9". The first
  // three alike are events of this kind, the others are counted until the run has ended.
  void Failed(proto::RunId run, std::string kind, const std::string& how, const std::string& where);
  void Ended(proto::RunId run);
  // A message was dropped. Each is counted, of each `kind` the first one is told.
  void Reject(const std::string& kind, const std::string& text);
  // A worker was turned away. Each is counted, a few in a minute are told.
  void Refuse(const std::string& label, const std::string& reason, TimePoint now);

  // What happened since the last call, oldest first.
  std::vector<DispatchEvent> TakeEvents() { return std::exchange(events_, {}); }
  std::uint64_t rejected() const { return rejected_; }
  std::uint64_t refused() const { return refused_; }
  const std::string& last_refusal() const { return last_refusal_; }  // its reason

 private:
  std::vector<DispatchEvent> events_;
  struct Failures {
    std::string kind;
    std::map<std::string, std::uint64_t> alike;  // by how they failed
  };
  std::map<proto::RunId, Failures> failures_;  // of runs that have not ended
  std::uint64_t rejected_ = 0;
  std::set<std::string> rejected_kinds_;  // that have been told
  std::uint64_t refused_ = 0;
  std::string last_refusal_;
  int refusals_told_ = 0;
  TimePoint refusals_told_since_{};
  std::uint64_t refusals_untold_ = 0;
};

}  // namespace gauntlet
