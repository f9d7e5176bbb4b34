// Where the cases of a stream come from while its master lives, and where answers go.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>

#include "base/result.h"
#include "master/store/result_store.h"
#include "search/given/case_stream.h"

namespace gauntlet {

// Thread-safety: the master's thread.
class EvaluationFeed {
 public:
  virtual ~EvaluationFeed() = default;

  // Once, before anything else: adds to the stream what was asked of a former master and not told to the
  // search. Both outlive the feed. `search`: the number of the stream in the store.
  virtual Status Begin(SearchId search, CaseStream& stream, ResultStore& store) = 0;
  // Adds what has come, as long as fewer than `window` cases are open, and hands out answers. Never blocks.
  // Error: nobody will read the answers.
  virtual Status Turn(std::size_t window) = 0;
  // All runs of an evaluation are durable.
  virtual void Answer(const EvaluationRequest& request, std::span<const StoredRun* const> runs) = 0;
  // What becomes readable when Turn has something to do; -1 = nothing is waited for.
  virtual int fd() const = 0;
  // After how long Turn has to be called at the latest.
  virtual std::chrono::milliseconds patience() const = 0;
  // No more will come, and all answers are handed out.
  virtual bool Drained() const = 0;
};

}  // namespace gauntlet
