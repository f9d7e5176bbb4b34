#include "tests/integration/worker_crowd.h"

#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <zmq.hpp>

#include "base/system/unique_fd.h"
#include "proto/access_file.h"
#include "proto/message_codec.h"
#include "proto/run_codec.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

namespace {

constexpr std::size_t kConnectedBetween = 8;

}  // namespace

struct WorkerCrowd::Shared {
  zmq::context_t context{1};
  proto::Access access;
  proto::Hello hello;
  UniqueFd news{epoll_create1(EPOLL_CLOEXEC)};
};

struct WorkerCrowd::Worker {
  zmq::socket_t socket;
  bool welcomed = false;
  milliseconds pace{1000};  // that it was told
  steady_clock::time_point next_beat = {};
  std::vector<proto::Lease> leases;     // not answered
  std::vector<proto::Fence> handed_in;  // not acknowledged

  void Say(const proto::WorkerMessage& message) {
    socket.send(zmq::buffer(proto::EncodeWorkerMessage(message)), zmq::send_flags::none);
  }
};

WorkerCrowd::WorkerCrowd(const std::string& dir, int workers, const proto::GoldenHashes& golden_hashes,
                         std::uint64_t first)
    : first_(first), shared_(std::make_unique<Shared>()) {
  Result<proto::Access> access = proto::ReadAccess(dir + "/access.json");
  EXPECT_TRUE(access.ok()) << (access.ok() ? "" : access.error().message);
  if (!access) return;
  shared_->access = *std::move(access);
  shared_->context.set(zmq::ctxopt::max_sockets, workers + 16);
  shared_->hello.campaign_id = shared_->access.campaign_id;
  shared_->hello.software_version = GAUNTLET_VERSION;
  shared_->hello.golden_hashes = golden_hashes;
  shared_->hello.process.host = "crowd";
  shared_->hello.process.pid = getpid();
  // A connection and a mailbox for each.
  rlimit limit{};
  const auto needed = static_cast<rlim_t>(4 * workers + 256);
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < needed) {
    limit.rlim_cur = std::min(limit.rlim_max, needed);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  for (int i = 0; i < workers; ++i) workers_.push_back(std::make_unique<Worker>());
}

WorkerCrowd::~WorkerCrowd() = default;

bool WorkerCrowd::Join(milliseconds patience) {
  const auto end = steady_clock::now() + patience;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    zmq::socket_t& socket = workers_[i]->socket;
    socket = zmq::socket_t(shared_->context, zmq::socket_type::dealer);
    socket.set(zmq::sockopt::linger, 0);
    if (const auto& curve = shared_->access.curve) {
      socket.set(zmq::sockopt::curve_serverkey, curve->server_public);
      socket.set(zmq::sockopt::curve_publickey, curve->worker_public);
      socket.set(zmq::sockopt::curve_secretkey, curve->worker_secret);
    }
    socket.connect(shared_->access.endpoints.front());
    proto::Hello hello = shared_->hello;
    hello.instance_id = first_ + i;
    workers_[i]->Say(hello);
    Take(*workers_[i]);  // a socket tells of news from the moment on in which it was found empty
    epoll_event news{EPOLLIN, {.u64 = i}};
    epoll_ctl(shared_->news.get(), EPOLL_CTL_ADD, socket.get(zmq::sockopt::fd), &news);
    // Those that are there are to be heard meanwhile.
    if (i % kConnectedBetween == kConnectedBetween - 1) Listen(/*wait_ms=*/0);
  }
  while (!workers_.empty() && steady_clock::now() < end) {
    Listen();
    if (std::all_of(workers_.begin(), workers_.end(), [](const auto& one) { return one->welcomed; }))
      return true;
  }
  return false;
}

double WorkerCrowd::AwaitLeases(std::size_t leases, milliseconds patience) {
  const auto start = steady_clock::now();
  while (steady_clock::now() - start < patience) {
    std::size_t held = 0;
    bool all = true;
    for (const auto& one : workers_) {
      held += one->leases.size();
      all = all && !one->leases.empty();
    }
    if (all && held >= leases) return std::chrono::duration<double>(steady_clock::now() - start).count();
    Listen();
  }
  return -1.0;
}

std::size_t WorkerCrowd::AnswerAll(const sim::RunResult& result, double cpu_seconds) {
  const std::string bytes = proto::EncodeRunResult(result, proto::TrajectoryEncoding::kLeaveOut);
  std::size_t answers = 0;
  for (const auto& one : workers_) {
    for (const proto::Lease& lease : one->leases) {
      one->Say(proto::LeaseResult{lease.fence, lease.run_id, bytes, std::nullopt, cpu_seconds});
      one->handed_in.push_back(lease.fence);
      ++answers;
    }
    one->leases.clear();
    Take(*one);
  }
  return answers;
}

void WorkerCrowd::SayGoodbye() {
  for (std::size_t i = 0; i < workers_.size(); i += 2) workers_[i]->Say(proto::Goodbye{});
  // Until the messages have left.
  for (const auto& one : workers_) one->socket.set(zmq::sockopt::linger, 1000);
}

void WorkerCrowd::Beat() {
  const auto now = steady_clock::now();
  for (const auto& one : workers_) {
    if (!one->welcomed || now < one->next_beat) continue;
    one->next_beat = now + one->pace;
    proto::Heartbeat beat{1, one->handed_in};
    for (const proto::Lease& lease : one->leases) beat.held_leases.push_back(lease.fence);
    one->Say(beat);
    Take(*one);
  }
}

// Waits a little for messages, and takes in what is there. Sending may swallow the news of a socket, so it is
// looked at then too.
void WorkerCrowd::Listen(int wait_ms) {
  std::array<epoll_event, 1024> events;
  const int ready = epoll_wait(shared_->news.get(), events.data(), events.size(), wait_ms);
  for (int i = 0; i < ready; ++i) Take(*workers_[events[i].data.u64]);
  Beat();
}

void WorkerCrowd::Take(Worker& one) {
  zmq::message_t frame;
  while (one.socket.recv(frame, zmq::recv_flags::dontwait)) {
    Result<proto::MasterMessage> message = proto::DecodeMasterMessage(frame.to_string());
    EXPECT_TRUE(message.ok()) << (message.ok() ? "" : message.error().message);
    if (!message) continue;
    if (const auto* welcome = std::get_if<proto::Welcome>(&*message)) {
      one.welcomed = true;
      one.pace = welcome->heartbeat;
      one.next_beat = steady_clock::now() + one.pace;
    }
    if (auto* lease = std::get_if<proto::Lease>(&*message)) one.leases.push_back(std::move(*lease));
    if (const auto* refused = std::get_if<proto::Refused>(&*message)) ADD_FAILURE() << refused->reason;
    if (const auto* acknowledge = std::get_if<proto::Acknowledge>(&*message)) {
      for (const proto::Fence fence : acknowledge->fences) std::erase(one.handed_in, fence);
    }
  }
}

// `gauntlet master flocking` for workers whose runs do nothing.
std::unique_ptr<Process> StartNoopMaster(const std::string& dir, const std::string& endpoint, int population,
                                         int replicates, int generations) {
  return std::make_unique<Process>(
      std::vector<std::string>{GAUNTLET_BINARY_DIR "/gauntlet", "master", "flocking", "--bind", endpoint,
                               "--dir", dir, "--quiet", "--population", std::to_string(population),
                               "--generations", std::to_string(generations), "--set",
                               "search.replicates=" + std::to_string(replicates)},
      std::vector<std::string>{std::string("GAUNTLET_WORKER=") + GAUNTLET_BINARY_DIR
                               "/gauntlet-worker-noop"});
}

}  // namespace gauntlet::testing_support
