// HTTP on this machine's own address: the one door to the library that speaks it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"

namespace gauntlet {

// A GET; or a HEAD, of whose answer no body is sent.
struct HttpRequest {
  std::string path;  // without the query, percent-encoding undone
  std::string host;  // of the header Host, as all the others; "" = there is none
  std::string origin;
};

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
};

using HttpHandler = std::function<HttpAnswer(const HttpRequest&)>;

struct HttpOptions {
  int port = 0;                          // 0 to 65535; 0 = any free one
  std::string failure = "cannot serve";  // how the error of a port that cannot be had begins
  // So many answers are made side by side. 0: they take no time, and are made on the thread of the sockets.
  std::size_t answering_threads = 0;
  // When one more comes, the oldest that has not asked for anything yet is closed.
  std::size_t most_connections = 128;
  std::uint32_t longest_head = 16 << 10;
  std::uint32_t longest_body = 16 << 10;              // which nobody reads
  std::chrono::milliseconds asking_time{1000};        // for a whole request
  std::chrono::milliseconds standstill_time{10'000};  // of an answer of which the other side takes nothing
};

// One thread serves all connections side by side, a request each. No signal comes in on its threads. What is
// no HTTP, too long, or neither GET nor HEAD it refuses itself, and what `answer` throws is a 500.
class HttpServer {
 public:
  // Listens on 127.0.0.1. kInUse when another program has the port.
  static Result<std::unique_ptr<HttpServer>> Start(HttpOptions options, HttpHandler answer);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  // Breaks all connections off at once; waits for nothing but calls of `answer` that have begun.
  ~HttpServer();

  int port() const;

 private:
  class Connection;
  struct Running;
  explicit HttpServer(std::unique_ptr<Running> running);

  std::unique_ptr<Running> running_;
};

}  // namespace gauntlet
