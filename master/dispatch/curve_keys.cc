#include "master/dispatch/curve_keys.h"

#include <zmq.h>

#include <array>

#include "base/check.h"

namespace gauntlet::master {

CurveKeyPair NewCurveKeyPair() {
  std::array<char, 41> public_key{};  // with the zero at the end
  std::array<char, 41> secret_key{};
  GAUNTLET_CHECK(zmq_curve_keypair(public_key.data(), secret_key.data()) == 0,
                 "this ZeroMQ was built without CURVE");
  return {public_key.data(), secret_key.data()};
}

bool IsLocalEndpoint(std::string_view endpoint) {
  if (endpoint.starts_with("ipc://") || endpoint.starts_with("inproc://")) return true;
  constexpr std::string_view kTcp = "tcp://";
  if (!endpoint.starts_with(kTcp)) return false;
  const std::string_view host = endpoint.substr(kTcp.size(), endpoint.rfind(':') - kTcp.size());
  return host.starts_with("127.") || host == "localhost" || host == "[::1]";
}

}  // namespace gauntlet::master
