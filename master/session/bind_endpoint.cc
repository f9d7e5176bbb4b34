#include "master/session/bind_endpoint.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "base/parse_number.h"
#include "master/dispatch/wire/zmq_transport.h"

namespace gauntlet {
namespace {

constexpr std::string_view kTcpScheme = "tcp://";
constexpr std::string_view kIpcScheme = "ipc://";
// The system's limit, with the zero at its end.
constexpr std::size_t kLongestSocketPath = sizeof(sockaddr_un::sun_path) - 1;

bool IsPort(std::string_view text) {
  const auto port = ParseNumber<std::uint16_t>(text);
  return text == "*" || (port && *port >= 1);
}

bool IsInterface(const std::string& host, ListenOn where) {
  in_addr address{};
  if (host == "*" || inet_pton(AF_INET, host.c_str(), &address) == 1) return true;
  if (where == ListenOn::kThisMachine) return if_nametoindex(host.c_str()) != 0;
  // No interface is called so anywhere, but every machine calls itself so.
  return !host.empty() && host.size() < IFNAMSIZ && host != "localhost";
}

// "" when there is nothing.
std::string WhatIsWrong(const std::string& endpoint, ListenOn where) {
  if (endpoint.find('\0') != std::string::npos) return "it holds a zero byte";
  if (endpoint.starts_with(kIpcScheme)) {
    const std::size_t length = endpoint.size() - kIpcScheme.size();
    if (length == 0) return "the path is missing";
    if (length <= kLongestSocketPath) return "";
    return fmt::format("the path has {} bytes, the system allows {}", length, kLongestSocketPath);
  }
  if (!endpoint.starts_with(kTcpScheme)) return "workers connect by tcp:// or ipc:// only";
  const std::string rest = endpoint.substr(kTcpScheme.size());
  if (rest.starts_with('[')) return "IPv6 is not supported";
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos) return "the port is missing";
  const std::string host = rest.substr(0, colon);
  const std::string port = rest.substr(colon + 1);
  if (host.find(':') != std::string::npos) return "IPv6 is not supported";
  if (!IsInterface(host, where)) {
    return fmt::format(
        "'{}' is neither an IPv4 address nor an interface of this machine; names of hosts "
        "are not looked up",
        host);
  }
  if (!IsPort(port)) return fmt::format("'{}' is no port", port);
  return "";
}

std::vector<std::string> OwnAddresses() {
  std::vector<std::string> addresses;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return addresses;
  for (const ifaddrs* item = list; item != nullptr; item = item->ifa_next) {
    if (item->ifa_addr == nullptr || item->ifa_addr->sa_family != AF_INET) continue;
    if ((item->ifa_flags & IFF_UP) == 0 || (item->ifa_flags & IFF_LOOPBACK) != 0) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(item->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr)
      addresses.emplace_back(text.data());
  }
  freeifaddrs(list);
  if (addresses.empty()) addresses.emplace_back("127.0.0.1");
  return addresses;
}

}  // namespace

Status CheckBindEndpoint(const std::string& endpoint, ListenOn where) {
  const std::string wrong = WhatIsWrong(endpoint, where);
  if (wrong.empty()) return Ok{};
  return InvalidInput(
      fmt::format("cannot listen on '{}': {}; it must be tcp://ADDRESS:PORT with an IPv4 address of this "
                  "machine (0.0.0.0: "
                  "all of them) and a port from 1 to 65535, or * for any free one, or ipc://PATH",
                  endpoint, wrong));
}

Status TryToListen(const std::string& endpoint) {
  ZmqTransportOptions options;
  options.endpoint = endpoint;
  TRY(ZmqTransport::Bind(options));
  return Ok{};
}

std::vector<std::string> ReachableEndpoints(const std::string& bound) {
  const std::size_t colon = bound.rfind(':');
  const std::string host = bound.substr(0, colon);
  if (host != "tcp://0.0.0.0" && host != "tcp://[::]") return {bound};
  const std::string port = bound.substr(colon);
  std::vector<std::string> endpoints;
  for (const std::string& address : OwnAddresses()) endpoints.push_back("tcp://" + address + port);
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0') {
    endpoints.push_back(fmt::format("tcp://{}{}", name.data(), port));
  }
  return endpoints;
}

}  // namespace gauntlet
