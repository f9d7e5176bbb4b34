#include "tests/perf/bare_loop.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <utility>
#include <vector>
#include <zmq.hpp>

namespace gauntlet::perf {
namespace {

// Z85, 40 characters and the end.
using Key = std::array<char, 41>;
struct Keys {
  Key server_public{};
  Key server_secret{};
  Key worker_public{};
  Key worker_secret{};
};

[[noreturn]] void ActAsWorker(int endpoint_fd, const BareLoop& loop, const Keys& keys) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  char endpoint[256] = {};
  if (read(endpoint_fd, endpoint, sizeof endpoint - 1) <= 0) _exit(1);
  zmq::context_t context(1);
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  if (loop.curve) {
    socket.set(zmq::sockopt::curve_serverkey, keys.server_public.data());
    socket.set(zmq::sockopt::curve_publickey, keys.worker_public.data());
    socket.set(zmq::sockopt::curve_secretkey, keys.worker_secret.data());
  }
  socket.connect(endpoint);
  while (true) {
    socket.send(zmq::buffer(loop.result), zmq::send_flags::none);
    zmq::message_t lease;
    (void)socket.recv(lease);
  }
}

double Exchange(zmq::socket_t& router, const BareLoop& loop) {
  zmq::message_t identity;
  zmq::message_t message;
  const auto answer = [&](std::size_t leases) {
    (void)router.recv(identity);
    (void)router.recv(message);
    for (std::size_t i = 0; i < leases; ++i) {
      router.send(zmq::buffer(identity.data(), identity.size()), zmq::send_flags::sndmore);
      router.send(zmq::buffer(loop.lease), zmq::send_flags::none);
    }
  };
  for (int i = 0; i < loop.workers; ++i) answer(loop.ahead);
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t done = 0; done < loop.exchanges; ++done) answer(1);
  return static_cast<double>(loop.exchanges) /
         std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

double RunBareLoop(const BareLoop& loop) {
  Keys keys;
  if (loop.curve && (zmq_curve_keypair(keys.server_public.data(), keys.server_secret.data()) != 0 ||
                     zmq_curve_keypair(keys.worker_public.data(), keys.worker_secret.data()) != 0)) {
    return 0.0;
  }
  std::vector<std::pair<pid_t, int>> children;
  for (int i = 0; i < loop.workers; ++i) {
    int fds[2];
    if (pipe(fds) != 0) return 0.0;
    const pid_t pid = fork();
    if (pid == 0) ActAsWorker(fds[0], loop, keys);
    close(fds[0]);
    children.emplace_back(pid, fds[1]);
  }
  double rate = 0.0;
  {
    zmq::context_t context(1);
    zmq::socket_t router(context, zmq::socket_type::router);
    router.set(zmq::sockopt::linger, 0);
    if (loop.curve) {
      router.set(zmq::sockopt::curve_server, true);
      router.set(zmq::sockopt::curve_secretkey, keys.server_secret.data());
    }
    router.bind("tcp://127.0.0.1:*");
    const std::string endpoint = router.get(zmq::sockopt::last_endpoint);
    bool told = true;
    for (const auto& [pid, fd] : children) told = told && write(fd, endpoint.data(), endpoint.size()) > 0;
    if (told) rate = Exchange(router, loop);
  }
  for (const auto& [pid, fd] : children) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
    close(fd);
  }
  return rate;
}

}  // namespace gauntlet::perf
