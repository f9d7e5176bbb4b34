#include "master/dispatch/hello_check.h"

#include <fmt/format.h>

#include "master/dispatch/dispatch_log.h"
#include "proto/golden_hashes.h"

namespace gauntlet::master {
namespace {

constexpr std::uint32_t kMaxSlots = 4096;

}  // namespace

std::string ReasonToRefuse(const proto::Hello& hello, const CampaignIdentity& identity) {
  if (hello.protocol_version != proto::kProtocolVersion) {
    return fmt::format(
        "this worker speaks protocol version {}, this master speaks {}: use gauntlet-worker {}",
        hello.protocol_version, proto::kProtocolVersion, identity.software_version);
  }
  if (hello.campaign_id != identity.campaign_id) {
    return fmt::format("this worker belongs to campaign '{}', this master serves campaign '{}'",
                       Shorten(hello.campaign_id), identity.campaign_id);
  }
  if (hello.software_version != identity.software_version) {
    return fmt::format("this worker has software version {}, this master has {}",
                       Shorten(hello.software_version), identity.software_version);
  }
  if (const auto difference = proto::FirstDifference(identity.golden_hashes, hello.golden_hashes)) {
    if (!difference->offered) {
      return fmt::format("this worker was built without the controller '{}', which the campaign uses",
                         difference->controller);
    }
    return fmt::format(
        "this worker's golden hash of controller '{}' is {:016x}, the campaign's is {:016x}: the same runs "
        "end differently on its machine, so its results cannot be mixed with the others",
        difference->controller, *difference->offered, difference->needed);
  }
  if (hello.instance_id == 0) return "this worker has instance id 0; it must be a random number";
  if (hello.slots < 1 || hello.slots > kMaxSlots) {
    return fmt::format("this worker has {} slots; 1 to {} are possible", hello.slots, kMaxSlots);
  }
  return "";
}

}  // namespace gauntlet::master
