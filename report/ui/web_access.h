// Who may see the pages: whoever knows the address that was printed, in a browser that shows it.
#pragma once

#include <optional>
#include <string>

#include "master/http/http_server.h"

namespace gauntlet {

// A secret of 128 random bits, in hexadecimal digits.
std::string NewToken();

// "http://127.0.0.1:43211/TOKEN/"
std::string AddressOf(int port, const std::string& token);

// The path behind the token, "" of the first page; the refusal of a request that has no business here:
// another site's page sends it or has a name of its own point here (Host and Origin are not this machine:
// 403), it does not know the token (403), or its path has "..": 404.
// Host may name any port, so that the pages can be reached through a tunnel.
struct Admission {
  std::string path;
  std::optional<HttpAnswer> refusal;
};
Admission Admit(const HttpRequest& request, const std::string& token);

}  // namespace gauntlet
