// Transport in memory: tests put messages in and read what was sent. Waiting advances a FakeClock.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "master/dispatch/wire/transport.h"
#include "tests/support/fake_clock.h"

namespace gauntlet::testing_support {

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(FakeClock& clock) : clock_(clock) {}

  // What peers do.
  void Deliver(const PeerId& peer, std::string bytes) { inbox_.push_back({peer, std::move(bytes)}); }
  // Takes what was sent to the peer.
  std::vector<std::string> TakeSentTo(const PeerId& peer) { return std::exchange(outbox_[peer], {}); }
  void SetUnreachable(const PeerId& peer) { unreachable_.insert(peer); }
  void SetFull(const PeerId& peer, bool full) { full ? (void)full_.insert(peer) : (void)full_.erase(peer); }
  // Called in every Wait, after the clock has moved: fake workers live here.
  std::function<void()> on_wait;
  std::vector<int> ready_fds;  // what the next Wait answers, as far as it was asked for
  TransportRejections rejections;
  bool knows_its_peers = true;
  int greeting = 0;

  SendOutcome Send(const PeerId& peer, std::string_view bytes) override {
    if (unreachable_.contains(peer)) return SendOutcome::kUnreachable;
    if (full_.contains(peer)) return SendOutcome::kFull;
    outbox_[peer].emplace_back(bytes);
    return SendOutcome::kSent;
  }
  void Receive(std::size_t limit, std::vector<PeerMessage>& messages) override {
    for (; limit > 0 && !inbox_.empty(); --limit) {
      messages.push_back(std::move(inbox_.front()));
      inbox_.pop_front();
    }
  }
  WaitOutcome Wait(std::chrono::milliseconds timeout, std::span<const int> fds) override {
    WaitOutcome outcome;
    for (const int fd : fds) {
      for (const int ready : ready_fds) {
        if (fd == ready) outcome.ready_fds.push_back(fd);
      }
    }
    outcome.woken = std::exchange(woken_, false);
    if (inbox_.empty() && outcome.ready_fds.empty() && !outcome.woken) clock_.Advance(timeout);
    if (on_wait) on_wait();
    outcome.messages = !inbox_.empty();
    return outcome;
  }
  void WakeUp() override { woken_ = true; }
  TransportRejections Rejections() const override { return rejections; }
  bool KnowsItsPeers() const override { return knows_its_peers; }
  int Greeting() const override { return greeting; }

 private:
  FakeClock& clock_;
  std::deque<PeerMessage> inbox_;
  std::map<PeerId, std::vector<std::string>> outbox_;
  std::set<PeerId> unreachable_;
  std::set<PeerId> full_;
  bool woken_ = false;
};

}  // namespace gauntlet::testing_support
