// What a run costs besides its simulation, three times over the same number of worker processes on loopback:
//
//   bare       a ROUTER and DEALERs that exchange messages of a lease's and a result's size
//   dispatch   protobuf, leases, scheduler; workers that answer at once; nothing stored
//   whole      gauntlet with gauntlet-worker-noop: supervisors, runners, search, every result durable
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
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "master/dispatch/remote_backend.h"
#include "master/dispatch/run_codec.h"
#include "master/dispatch/zmq_transport.h"
#include "proto/protocol.pb.h"
#include "tests/master/dispatch/sample_runs.h"

namespace gauntlet::master {
namespace {

using std::chrono::milliseconds;

[[noreturn]] void ActAsWorker(int endpoint_fd, std::uint64_t instance, milliseconds duration) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  char endpoint[256] = {};
  if (read(endpoint_fd, endpoint, sizeof endpoint - 1) <= 0) _exit(1);
  sim::RunResult result = SampleResult(0.5);
  result.trajectory.clear();
  const std::string bytes = EncodeRunResult(result);

  zmq::context_t context(1);
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.connect(endpoint);
  v1::Envelope envelope;
  v1::Hello& hello = *envelope.mutable_hello();
  hello.set_protocol_version(kProtocolVersion);
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

[[noreturn]] void ActAsBareWorker(int endpoint_fd, std::size_t result_bytes) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  char endpoint[256] = {};
  if (read(endpoint_fd, endpoint, sizeof endpoint - 1) <= 0) _exit(1);
  zmq::context_t context(1);
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.connect(endpoint);
  const std::string result(result_bytes, 'r');
  while (true) {
    socket.send(zmq::buffer(result), zmq::send_flags::none);
    zmq::message_t lease;
    (void)socket.recv(lease);
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

void RunBare(std::size_t runs, int workers, std::uint32_t credit) {
  sim::RunResult result = SampleResult(0.5);
  result.trajectory.clear();
  const std::size_t result_bytes = EncodeRunResult(result).size();
  std::vector<std::pair<pid_t, int>> children;
  for (int i = 0; i < workers; ++i) {
    int fds[2];
    if (pipe(fds) != 0) return;
    const pid_t pid = fork();
    if (pid == 0) ActAsBareWorker(fds[0], result_bytes);
    close(fds[0]);
    children.emplace_back(pid, fds[1]);
  }
  zmq::context_t context(1);
  zmq::socket_t router(context, zmq::socket_type::router);
  router.bind("tcp://127.0.0.1:*");
  const std::string endpoint = router.get(zmq::sockopt::last_endpoint);
  for (const auto& [pid, fd] : children) {
    if (write(fd, endpoint.data(), endpoint.size()) < 0) return;
  }
  const std::string lease = EncodeRunSpec(SampleSpec());
  zmq::message_t identity;
  zmq::message_t message;
  const auto answer = [&](std::uint32_t leases) {
    (void)router.recv(identity);
    (void)router.recv(message);
    for (std::uint32_t i = 0; i < leases; ++i) {
      router.send(zmq::buffer(identity.data(), identity.size()), zmq::send_flags::sndmore);
      router.send(zmq::buffer(lease), zmq::send_flags::none);
    }
  };
  for (int i = 0; i < workers; ++i) answer(credit);
  const auto start = std::chrono::steady_clock::now();
  const double cpu = CpuSeconds();
  for (std::size_t done = 0; done < runs; ++done) answer(1);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto count = static_cast<double>(runs);
  fmt::print("bare:     {:.0f}/s, master CPU {:.1f} us per run\n", count / wall,
             1e6 * (CpuSeconds() - cpu) / count);
  for (const auto& [pid, fd] : children) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
    close(fd);
  }
}

// The programs beside this one; the figures are those that gauntlet prints.
void RunWhole(std::size_t runs, int workers, milliseconds duration) {
  const std::string bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string scratch = fmt::format("{}/gauntlet-dispatch-benchmark.{}",
                                          std::filesystem::temp_directory_path().string(), getpid());
  std::filesystem::create_directories(scratch);
  constexpr std::size_t kMostReplicates = 10000;
  const std::size_t cases = (runs + kMostReplicates - 1) / kMostReplicates;
  std::string files;
  for (std::size_t i = 0; i < cases; ++i) {
    const std::string file = fmt::format("{}/case-{}.json", scratch, i);
    std::ofstream(file) << "{\"name\": \"empty\"}";
    files += " " + file;
  }
  const std::string delay =
      duration.count() > 0 ? fmt::format("GAUNTLET_NOOP_MS={} ", duration.count()) : std::string();
  fmt::print("whole:    ");
  std::fflush(stdout);
  const std::string command = fmt::format(
      "{0}GAUNTLET_WORKER={1}/gauntlet-worker-noop {1}/gauntlet evaluate flocking --case{5} "
      "--replicates {3} --workers {4} --dir {2}/campaign --no-progress 2>&1 >/dev/null | tail -n 1",
      delay, bin, scratch, runs / cases, workers, files);
  if (std::system(command.c_str()) != 0) fmt::print("failed\n");
  std::filesystem::remove_all(scratch);
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
  RemoteBackend backend({"benchmark", 1, "", 0}, options, **transport, clock);
  const std::string& endpoint = (*transport)->endpoint();
  for (const int fd : endpoint_fds) {
    if (write(fd, endpoint.data(), endpoint.size()) < 0) return 1;
  }
  while (backend.Statistics().connected < workers) (void)backend.Poll(milliseconds(10));

  const std::string spec = EncodeRunSpec(SampleSpec());
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
}  // namespace gauntlet::master

int main(int argc, char** argv) {
  const auto number = [&](int index, int fallback) {
    return argc > index ? std::atoi(argv[index]) : fallback;
  };
  const auto runs = static_cast<std::size_t>(number(1, 50000));
  const int workers = number(2, 2);
  const auto credit = static_cast<std::uint32_t>(number(3, 2));
  const std::chrono::milliseconds duration(number(4, 0));
  fmt::print("{} runs of {} ms, {} workers, credit {}\n", runs, duration.count(), workers, credit);
  if (duration.count() == 0) gauntlet::master::RunBare(runs, workers, credit);
  std::fflush(stdout);
  const int failed = gauntlet::master::Run(runs, workers, credit, duration);
  std::fflush(stdout);
  gauntlet::master::RunWhole(runs, workers, duration);
  return failed;
}
