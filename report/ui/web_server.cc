#include "report/ui/web_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>

#include <cerrno>
#include <thread>
#include <utility>

#include "base/system/atomic_file.h"

namespace gauntlet {
namespace {

constexpr const char* kAddress = "127.0.0.1";
constexpr std::size_t kThreads = 16;  // a browser keeps up to six connections open
// How long a connection may be silent. The end of the server waits for it.
constexpr time_t kPatienceSeconds = 1;

void Answer(WebAnswer answer, httplib::Response& response) {
  response.status = answer.status;
  // What is set as content, the library compresses, at several times the cost of everything else here.
  const std::size_t size = answer.body.size();
  response.set_content_provider(
      size, answer.type,
      [body = std::move(answer.body)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(body.data() + offset, length);
      });
  // The pages' own rules stand in the pages; these hold for whatever is answered.
  response.set_header("Content-Security-Policy",
                      "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  response.set_header("Cache-Control", "no-store");
}

}  // namespace

struct WebServer::Running {
  httplib::Server server;
  int port = 0;
  std::thread thread;
};

Result<std::unique_ptr<WebServer>> WebServer::Start(int port,
                                                    std::function<WebAnswer(const WebRequest&)> answer) {
  auto running = std::make_unique<Running>();
  httplib::Server& server = running->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // A page asks once a second: to wait for that on an open connection costs more than a new one. It also
  // leaves bodies unread that nobody asked for.
  server.set_keep_alive_max_count(1);
  server.set_read_timeout(kPatienceSeconds);
  // The library's own choice lets two servers have one port.
  server.set_socket_options([](socket_t socket) {
    const int reuse = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  });
  server.set_pre_routing_handler(
      [answer = std::move(answer)](const httplib::Request& request, httplib::Response& response) {
        const WebRequest asked{request.method, request.path, request.get_header_value("Host"),
                               request.get_header_value("Origin")};
        Answer(answer(asked), response);
        return httplib::Server::HandlerResponse::Handled;
      });
  errno = 0;
  running->port =
      port == 0 ? server.bind_to_any_port(kAddress) : (server.bind_to_port(kAddress, port) ? port : -1);
  if (running->port < 0) {
    Error error = SystemError(fmt::format("cannot serve on {}:{}", kAddress, port), errno);
    if (errno == EADDRINUSE) {
      error.kind = ErrorKind::kInUse;
      error.message += ": give --port another number, or 0 for any free one";
    }
    return error;
  }
  // Signals are for the thread that waits for them.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  running->thread = std::thread([&server] { server.listen_after_bind(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  while (!server.is_running()) std::this_thread::yield();  // until then it cannot be stopped
  return std::unique_ptr<WebServer>(new WebServer(std::move(running)));
}

WebServer::WebServer(std::unique_ptr<Running> running) : running_(std::move(running)) {}

WebServer::~WebServer() {
  running_->server.stop();
  running_->thread.join();
}

int WebServer::port() const {
  return running_->port;
}

}  // namespace gauntlet
