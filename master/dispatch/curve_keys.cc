#include "master/dispatch/curve_keys.h"

#include <zmq.h>

#include <array>

#include "base/check.h"

namespace gauntlet::master {
namespace {

constexpr std::size_t kKeyCharacters = 40;
constexpr std::size_t kKeyBytes = 32;

}  // namespace

CurveKeyPair NewCurveKeyPair() {
  std::array<char, kKeyCharacters + 1> public_key{};
  std::array<char, kKeyCharacters + 1> secret_key{};
  GAUNTLET_CHECK(zmq_curve_keypair(public_key.data(), secret_key.data()) == 0,
                 "this ZeroMQ was built without CURVE");
  return {public_key.data(), secret_key.data()};
}

bool IsCurveKey(std::string_view key) {
  std::array<std::uint8_t, kKeyBytes> bytes{};
  return key.size() == kKeyCharacters && zmq_z85_decode(bytes.data(), std::string(key).c_str()) != nullptr;
}

bool IsLocalEndpoint(std::string_view endpoint) {
  if (endpoint.starts_with("ipc://") || endpoint.starts_with("inproc://")) return true;
  constexpr std::string_view kTcp = "tcp://";
  if (!endpoint.starts_with(kTcp)) return false;
  const std::string_view host = endpoint.substr(kTcp.size(), endpoint.rfind(':') - kTcp.size());
  return host.starts_with("127.") || host == "localhost" || host == "[::1]";
}

}  // namespace gauntlet::master
