#include "master/session/bind_endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/local_socket.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(BindEndpoint, WhatWorkersCanReachIsAccepted) {
  for (const char* good : {"tcp://127.0.0.1:*", "tcp://0.0.0.0:1", "tcp://10.1.2.3:65535", "tcp://*:5555",
                           "tcp://lo:*", "ipc:///tmp/socket", "ipc://socket"}) {
    const Status checked = CheckBindEndpoint(good);
    EXPECT_TRUE(checked.ok()) << checked.error().message;
  }
}

TEST(BindEndpoint, AnythingElseIsRefusedWithTheReasonAndWhatWouldBeRight) {
  struct Case {
    std::string endpoint;
    std::string reason;
  };
  const std::string no_address = "is neither an IPv4 address nor an interface of this machine";
  for (const auto& [endpoint, reason] : std::vector<Case>{
           {"tcp://127.0.0.1:99999", "'99999' is no port"},
           {"tcp://127.0.0.1:65536", "'65536' is no port"},
           {"tcp://127.0.0.1:99999999999999999999", "is no port"},
           {"tcp://127.0.0.1:-1", "'-1' is no port"},
           {"tcp://127.0.0.1:+5", "'+5' is no port"},
           {"tcp://127.0.0.1:0", "'0' is no port"},
           {"tcp://127.0.0.1:", "'' is no port"},
           {"tcp://127.0.0.1:80 ", "'80 ' is no port"},
           {"tcp://127.0.0.1", "the port is missing"},
           {"tcp://localhost:*", "'localhost' " + no_address},
           {"tcp://nohost.invalid:*", "'nohost.invalid' " + no_address},
           {"tcp://127.0.0.1.1:*", no_address},
           {"tcp://:5555", no_address},
           {"tcp://[::1]:*", "IPv6 is not supported"},
           {"tcp://::1:5555", "IPv6 is not supported"},
           {"inproc://x", "tcp:// or ipc:// only"},
           {"udp://127.0.0.1:5", "tcp:// or ipc:// only"},
           {"127.0.0.1:5555", "tcp:// or ipc:// only"},
           {"", "tcp:// or ipc:// only"},
           {"ipc://", "the path is missing"},
           {"ipc:///" + std::string(200, 'x'), "the path has 201 bytes, the system allows 107"},
       }) {
    const Status checked = CheckBindEndpoint(endpoint);
    ASSERT_FALSE(checked.ok()) << endpoint;
    EXPECT_EQ(checked.error().kind, ErrorKind::kInvalidInput);
    EXPECT_THAT(checked.error().message,
                AllOf(HasSubstr("'" + endpoint + "'"), HasSubstr(reason),
                      HasSubstr("a port from 1 to 65535, or * for any free one, or ipc://PATH")));
  }
}

TEST(BindEndpoint, TheInterfacesOfAnotherMachineAreUnknown) {
  EXPECT_FALSE(CheckBindEndpoint("tcp://nosuch7:*").ok());
  EXPECT_TRUE(CheckBindEndpoint("tcp://nosuch7:*", ListenOn::kAnotherMachine).ok());
  for (const char* bad :
       {"tcp://localhost:*", "tcp://login.cluster.example:*", "tcp://:*", "tcp://nosuch7:0"})
    EXPECT_FALSE(CheckBindEndpoint(bad, ListenOn::kAnotherMachine).ok()) << bad;
}

TEST(BindEndpoint, WhatTheSystemRefusesIsSaid) {
  EXPECT_TRUE(TryToListen("tcp://127.0.0.1:*").ok());
  // TEST-NET-3 (RFC 5737): never an address of this machine.
  EXPECT_EQ(TryToListen("tcp://203.0.113.77:*").error().message,
            "cannot listen on 'tcp://203.0.113.77:*': Cannot assign requested address (an endpoint looks "
            "like tcp://127.0.0.1:5555, or tcp://127.0.0.1:* for any free port)");
  const testing_support::ListeningSocket taken;
  const Status refused = TryToListen("tcp://127.0.0.1:" + std::to_string(taken.port()));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInUse);
}

}  // namespace
}  // namespace gauntlet
