// HTTP on this machine's own address: the one door to the library that speaks it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/result.h"

namespace gauntlet {

struct WebRequest {
  std::string method;  // "GET"; "HEAD" asks for the same, of which no body is sent
  std::string path;    // without the query, percent-encoding undone
  std::string host;    // of the header Host, as all the others; "" = there is none
  std::string origin;
};

struct WebAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
};

// Requests are answered side by side, by a few threads of its own, on which no signal comes in.
class WebServer {
 public:
  // Listens on 127.0.0.1. `port`: 0 to 65535; 0 = any free one. `answer` is called from several threads at a
  // time. kInUse when another program has the port.
  static Result<std::unique_ptr<WebServer>> Start(int port,
                                                  std::function<WebAnswer(const WebRequest&)> answer);
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  // Lets answers that have begun end.
  ~WebServer();

  int port() const;

 private:
  struct Running;
  explicit WebServer(std::unique_ptr<Running> running);

  std::unique_ptr<Running> running_;
};

}  // namespace gauntlet
