// Whether runs end the same when they are simulated again. Gauntlet's own are promised to; of a program of
// the user's nobody knows, so it is observed: its first runs are simulated once more, and every other
// difference that comes up counts too. An observation changes which leases are given and who is believed, and
// no result.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/system/clock.h"
#include "proto/messages.h"

namespace gauntlet {

enum class Reproducible {
  kPromised,  // runs are pure functions: where they differ, a worker or a plug-in is at fault
  kUnknown,   // not enough has been seen
  kYes,       // as far as has been seen
  kNo,        // for good
};

// What has become known, for people: "hosts a, b" of kYes, else "run 17 ended differently when it was
// simulated again on a".
struct ReproducibilityNews {
  Reproducible state = Reproducible::kUnknown;
  std::string text;
};

class Reproducibility {
 public:
  // So many runs that end the same make kYes.
  static constexpr std::size_t kChecks = 3;
  // From a run's end to its second beginning at least: a program may be seeded by the clock in whole seconds.
  static constexpr std::chrono::seconds kPause{2};

  explicit Reproducibility(Reproducible known) : state_(known) {}

  Reproducible state() const { return state_; }
  bool observed() const { return state_ != Reproducible::kPromised; }
  // A run's own first ending is its result: another attempt would be another throw of the dice.
  bool first_ending_counts() const { return state_ == Reproducible::kUnknown || state_ == Reproducible::kNo; }

  // A run was simulated to its end on this host. True: it is one of those that are simulated once more.
  bool Check(proto::RunId run, const std::string& host);
  bool Checks(proto::RunId run) const { return open_.contains(run); }
  // Those that have not been, with the host of the first time.
  const std::map<proto::RunId, std::string>& open() const { return open_; }

  // The second time, on this host, it ended the same; without meaning for runs that are not checked.
  void Same(proto::RunId run, const std::string& host);
  // It ended differently, whatever it was simulated again for.
  void Differs(proto::RunId run, const std::string& host);

  // Since the last call.
  std::optional<ReproducibilityNews> TakeNews() { return std::exchange(news_, std::nullopt); }

 private:
  Reproducible state_;
  std::map<proto::RunId, std::string> open_;
  std::size_t begun_ = 0;
  std::size_t same_ = 0;
  std::set<std::string> hosts_;  // that agreed
  std::optional<ReproducibilityNews> news_;
};

}  // namespace gauntlet
