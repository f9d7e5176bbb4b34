#include "report/ui/web_access.h"

#include <fmt/format.h>
#include <sodium.h>

#include <array>
#include <string_view>

namespace gauntlet {
namespace {

HttpAnswer Refused(int status, const std::string& reason) {
  return {.status = status, .body = reason + "\n"};
}

// "localhost:43211" is this machine; a name that somebody else made point here is not.
bool IsThisMachine(std::string_view host) {
  const std::string_view name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost";
}

// Without telling by its time how much of the token was right.
bool BeginsWithToken(std::string_view path, std::string_view token) {
  return path.size() > token.size() + 1 && path.front() == '/' && path[token.size() + 1] == '/' &&
         sodium_memcmp(path.data() + 1, token.data(), token.size()) == 0;
}

}  // namespace

std::string NewToken() {
  std::array<unsigned char, 16> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

std::string AddressOf(int port, const std::string& token) {
  return fmt::format("http://127.0.0.1:{}/{}/", port, token);
}

Admission Admit(const HttpRequest& request, const std::string& token) {
  if (!IsThisMachine(request.host)) return {"", Refused(403, "this host is not served here")};
  if (!request.origin.empty() && request.origin != "http://" + request.host)
    return {"", Refused(403, "pages of other sites are not answered")};
  if (!BeginsWithToken(request.path, token))
    return {"", Refused(403, "the address lacks the token: take the one that 'gauntlet ui' printed")};
  const std::string path = request.path.substr(token.size() + 2);
  if (path.find("..") != std::string::npos) return {"", Refused(404, "there is no such page")};
  return {path, std::nullopt};
}

}  // namespace gauntlet
