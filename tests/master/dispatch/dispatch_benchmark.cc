// What dispatch alone costs: protobuf, leases and scheduler, with worker processes on loopback that answer at
// once; nothing is stored. throughput_report measures the whole service and the bare messages.
//
//   dispatch_benchmark [RUNS [WORKERS [CREDIT [MILLISECONDS]]]]      MILLISECONDS: how long a run takes
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "master/dispatch/remote_backend.h"
#include "master/dispatch/wire/zmq_transport.h"
#include "proto/protocol.pb.h"
#include "proto/run_codec.h"
#include "tests/master/dispatch/sample_runs.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;

[[noreturn]] void ActAsWorker(int endpoint_fd, std::uint64_t instance, milliseconds duration) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  char endpoint[256] = {};
  if (read(endpoint_fd, endpoint, sizeof endpoint - 1) <= 0) _exit(1);
  sim::RunResult result = SampleResult(0.5);
  result.trajectory.clear();
  const std::string bytes = proto::EncodeRunResult(result);

  zmq::context_t context(1);
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.connect(endpoint);
  v1::Envelope envelope;
  v1::Hello& hello = *envelope.mutable_hello();
  hello.set_protocol_version(proto::kProtocolVersion);
  hello.set_campaign_id("benchmark");
  hello.set_instance_id(instance);
  hello.set_slots(1);
  socket.send(zmq::buffer(envelope.SerializeAsString()), zmq::send_flags::none);
  while (true) {
    zmq::message_t message;
    (void)socket.recv(message);
    envelope.ParseFromArray(message.data(), static_cast<int>(message.size()));
    if (envelope.has_drain()) _exit(0);
    if (!envelope.has_lease()) continue;
    if (duration.count() > 0) std::this_thread::sleep_for(duration);
    v1::Envelope answer;
    v1::LeaseResult& lease_result = *answer.mutable_lease_result();
    lease_result.set_fence(envelope.lease().fence());
    lease_result.set_run_id(envelope.lease().run_id());
    lease_result.set_result(bytes);
    socket.send(zmq::buffer(answer.SerializeAsString()), zmq::send_flags::none);
  }
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
}

int Run(std::size_t runs, int workers, std::uint32_t credit, milliseconds duration) {
  std::vector<int> endpoint_fds;
  std::vector<pid_t> pids;
  for (int i = 0; i < workers; ++i) {
    int fds[2];
    if (pipe(fds) != 0) return 1;
    const pid_t pid = fork();
    if (pid == 0) ActAsWorker(fds[0], static_cast<std::uint64_t>(i) + 1, duration);
    close(fds[0]);
    endpoint_fds.push_back(fds[1]);
    pids.push_back(pid);
  }
  Result<std::unique_ptr<ZmqTransport>> transport = ZmqTransport::Bind();
  DispatchOptions options;
  options.credit = credit;
  // These workers send no heartbeats.
  options.lost_after = 1000000;
  const SteadyClock clock;
  RemoteBackend backend({"benchmark", 1, "", {}}, options, **transport, clock);
  const std::string& endpoint = (*transport)->endpoint();
  for (const int fd : endpoint_fds) {
    if (write(fd, endpoint.data(), endpoint.size()) < 0) return 1;
  }
  while (backend.Statistics().connected < workers) (void)backend.Poll(milliseconds(10));

  const std::string spec = proto::EncodeRunSpec(SampleSpec());
  std::vector<RunRequest> requests;
  for (RunId run = 1; run <= runs; ++run) requests.push_back({run, spec});
  const TimePoint start = clock.Now();
  const double cpu = CpuSeconds();
  backend.Submit(std::move(requests));
  std::vector<RunId> stored;
  for (std::size_t done = 0; done < runs;) {
    Result<std::vector<FinishedRun>> finished = backend.Poll(milliseconds(100));
    if (!finished) return 1;
    stored.clear();
    for (const FinishedRun& run : *finished) stored.push_back(run.id);
    backend.Acknowledge(stored);
    done += stored.size();
  }
  const double wall = std::chrono::duration<double>(clock.Now() - start).count();
  const double used = CpuSeconds() - cpu;
  const auto count = static_cast<double>(runs);
  fmt::print("dispatch: {:.0f}/s, master CPU {:.1f} us per run", count / wall, 1e6 * used / count);
  if (duration.count() > 0) {
    const double ideal = count * static_cast<double>(duration.count()) / 1000.0 / workers;
    fmt::print(", {:.3f} of ideal", ideal / wall);
  }
  fmt::print("\n");
  backend.Shutdown(milliseconds(100));
  for (const pid_t pid : pids) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
  return 0;
}

}  // namespace
}  // namespace gauntlet

int main(int argc, char** argv) {
  const auto number = [&](int index, int fallback) {
    return argc > index ? std::atoi(argv[index]) : fallback;
  };
  const auto runs = static_cast<std::size_t>(number(1, 50000));
  const int workers = number(2, 2);
  const auto credit = static_cast<std::uint32_t>(number(3, 2));
  const std::chrono::milliseconds duration(number(4, 0));
  fmt::print("{} runs of {} ms, {} workers, credit {}\n", runs, duration.count(), workers, credit);
  std::fflush(stdout);
  return gauntlet::Run(runs, workers, credit, duration);
}
