#include "master/session/reachable_endpoints.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace gauntlet::master {
namespace {

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

}  // namespace gauntlet::master
