#include "master/http/http_server.h"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <charconv>
#include <exception>
#include <list>
#include <string_view>
#include <thread>
#include <utility>

#include "base/system/atomic_file.h"

namespace gauntlet {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Failure = boost::system::error_code;

// "%2e" is a dot; what is no such number stands for itself.
std::string Decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char* const digits = text.data() + i + 1;
    unsigned char byte = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      plain += static_cast<char>(byte);
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

// What is said to somebody of whose request `failure` was all that could be made; 0 = nobody is there to
// hear.
int StatusOf(const Failure& failure) {
  const bool understood = failure.category() != make_error_code(http::error::bad_method).category();
  if (understood || failure == http::error::end_of_stream || failure == http::error::partial_message)
    return 0;
  if (failure == http::error::body_limit) return 413;
  return failure == http::error::header_limit || failure == http::error::buffer_overflow ? 431 : 400;
}

HttpAnswer AnswerOf(const HttpHandler& handler, const HttpRequest& request) {
  try {
    return handler(request);
  } catch (const std::exception& error) {
    return {.status = 500, .body = fmt::format("{}\n", error.what())};
  }
}

}  // namespace

struct HttpServer::Running {
  Running(HttpOptions with, HttpHandler handler);
  ~Running() {
    answering.stop();
    sockets.stop();
  }

  void Accept();
  void Admit(tcp::socket socket);

  const HttpOptions options;
  const HttpHandler answer;
  asio::io_context sockets{1};
  tcp::acceptor listener{sockets};
  asio::steady_timer pause{sockets};
  std::list<std::shared_ptr<Connection>> connections;  // the oldest first
  asio::thread_pool answering;
  std::jthread thread;  // of all the others but `answering`
};

// Reads one request and writes one answer.
class HttpServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Running& server, tcp::socket socket)
      : server_(server),
        stream_(std::move(socket)),
        buffer_(server.options.longest_head + server.options.longest_body) {
    parser_.header_limit(server.options.longest_head);
    parser_.body_limit(server.options.longest_body);
  }

  // Its request is whole, its answer is not sent yet.
  bool asked() const { return asked_; }

  void Read() {
    stream_.expires_after(server_.options.asking_time);
    http::async_read(
        stream_, buffer_, parser_,
        [self = shared_from_this()](const Failure& failure, std::size_t) { self->Answer(failure); });
  }

  void End() {
    stream_.close();
    server_.connections.remove(shared_from_this());
  }

 private:
  void Answer(const Failure& failure) {
    if (failure) {
      const int status = StatusOf(failure);
      return status == 0 ? End() : Send({.status = status, .body = failure.message() + "\n"});
    }
    const auto& request = parser_.get();
    head_ = request.method() == http::verb::head;
    if (!head_ && request.method() != http::verb::get)
      return Send({.status = 405, .body = "only GET and HEAD are answered here\n"});
    asked_ = true;
    const std::string_view target = request.target();
    auto answer = [self = shared_from_this(),
                   asked = HttpRequest{Decoded(target.substr(0, target.find('?'))),
                                       std::string(request[http::field::host]),
                                       std::string(request[http::field::origin])}] {
      asio::dispatch(self->server_.sockets, [self, made = AnswerOf(self->server_.answer, asked)]() mutable {
        self->Send(std::move(made));
      });
    };
    if (server_.options.answering_threads == 0) return answer();
    asio::post(server_.answering, std::move(answer));
  }

  void Send(HttpAnswer answer) {
    response_.result(static_cast<unsigned>(answer.status));
    response_.set(http::field::content_type, answer.type);
    response_.content_length(answer.body.size());
    response_.keep_alive(false);
    if (answer.status == 405) response_.set(http::field::allow, "GET, HEAD");
    // The pages' own rules stand in the pages; these hold for whatever is answered.
    response_.set("Content-Security-Policy", "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set(http::field::cache_control, "no-store");
    if (!head_) response_.body() = std::move(answer.body);
    Write();
  }

  void Write() {
    stream_.expires_after(server_.options.standstill_time);
    http::async_write_some(stream_, serializer_,
                           [self = shared_from_this()](const Failure& failure, std::size_t) {
                             if (failure) return self->End();
                             self->serializer_.is_done() ? self->HangUp() : self->Write();
                           });
  }

  // Waits for the other side to do the same: who is cut off while it still sends never sees the answer.
  void HangUp() {
    asked_ = false;
    Failure ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(server_.options.asking_time);
    Drain();
  }

  void Drain() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(server_.options.longest_body),
                            [self = shared_from_this()](const Failure& failure, std::size_t) {
                              failure ? self->End() : self->Drain();
                            });
  }

  Running& server_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  http::response_serializer<http::string_body> serializer_{response_};
  bool head_ = false;
  bool asked_ = false;
};

HttpServer::Running::Running(HttpOptions with, HttpHandler handler)
    : options(std::move(with)), answer(std::move(handler)), answering(options.answering_threads) {
  listener.open(tcp::v4());
  listener.set_option(tcp::acceptor::reuse_address(true));
  listener.bind({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(options.port)});
  listener.listen();
  Accept();
  thread = std::jthread([this] { sockets.run(); });
}

void HttpServer::Running::Accept() {
  listener.async_accept([this](const Failure& failure, tcp::socket socket) {
    if (!failure) {
      Admit(std::move(socket));
      return Accept();
    }
    // Out of descriptors: those that wait are announced again at once, so they are not looked at for a while.
    pause.expires_after(std::chrono::milliseconds(100));
    pause.async_wait([this](const Failure&) { Accept(); });
  });
}

void HttpServer::Running::Admit(tcp::socket socket) {
  if (connections.size() == options.most_connections) {
    const auto idle = std::ranges::find(connections, false, [](const auto& one) { return one->asked(); });
    (idle == connections.end() ? connections.front() : *idle)->End();
  }
  connections.push_back(std::make_shared<Connection>(*this, std::move(socket)));
  connections.back()->Read();
}

Result<std::unique_ptr<HttpServer>> HttpServer::Start(HttpOptions options, HttpHandler answer) {
  const std::string failed = fmt::format("{} on 127.0.0.1:{}", options.failure, options.port);
  // Signals are for the thread that waits for them.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  Result<std::unique_ptr<HttpServer>> server = [&]() -> Result<std::unique_ptr<HttpServer>> {
    try {
      return std::unique_ptr<HttpServer>(
          new HttpServer(std::make_unique<Running>(std::move(options), std::move(answer))));
    } catch (const boost::system::system_error& thrown) {
      Error error = SystemError(failed, thrown.code().value());
      if (thrown.code() == asio::error::address_in_use) error.kind = ErrorKind::kInUse;
      return error;
    }
  }();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return server;
}

HttpServer::HttpServer(std::unique_ptr<Running> running) : running_(std::move(running)) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
  return running_->listener.local_endpoint().port();
}

}  // namespace gauntlet
