// Transport over a ZeroMQ ROUTER socket; workers connect with DEALER sockets and send one frame per message.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "master/dispatch/wire/curve_keys.h"
#include "master/dispatch/wire/transport.h"

namespace gauntlet {

struct ZmqTransportOptions {
  std::string endpoint = "tcp://127.0.0.1:*";  // "*" as port: any free one
  // A longer message is dropped and counted; a connection that announces one longer than this and a mebibyte
  // is closed before its bytes are read. A connection whose message of many parts comes to four times this
  // without ending is closed and counted (TCP only: an ipc endpoint's folder says who may connect).
  std::size_t max_message_bytes = 16U << 20;
  int peer_queue = 1000;  // messages per peer and direction before it counts as not reading
  // A connection on which nothing has come for so long is asked for a sign of life, which every peer that
  // speaks ZeroMQ gives by itself, and is closed when none comes in the same time again. 0: never asked.
  std::chrono::milliseconds sign_of_life{30'000};
  // CURVE for everybody who connects; others than workers end in the handshake. None: plaintext, open to
  // whoever reaches the endpoint.
  std::optional<CampaignKeys> curve = std::nullopt;
};

class ZmqTransport : public Transport {
 public:
  // Binds. Error: the endpoint is malformed, in use or not ours.
  static Result<std::unique_ptr<ZmqTransport>> Bind(const ZmqTransportOptions& options = {});

  // What workers connect to: the port is the real one.
  virtual const std::string& endpoint() const = 0;
};

}  // namespace gauntlet
