#include "master/dispatch/wire/admission.h"

#include <fmt/format.h>

#include "controllers/command/definition.h"

#include "master/dispatch/dispatch_log.h"

namespace gauntlet {
namespace {

constexpr std::uint32_t kMaxSlots = 4096;  // of a worker

Refusal SameForAll(const std::string& reason) {
  return {reason, reason};
}

}  // namespace

std::optional<Refusal> ReasonToRefuse(const proto::Hello& hello, const CampaignIdentity& identity) {
  if (hello.protocol_version != proto::kProtocolVersion) {
    const std::string theirs =
        fmt::format("this worker speaks protocol version {}, this master speaks ", hello.protocol_version);
    return Refusal{fmt::format("{}{}: use gauntlet-worker {}", theirs, proto::kProtocolVersion,
                               identity.software_version),
                   theirs + "another: use the gauntlet-worker that came with the master"};
  }
  if (hello.campaign_id != identity.campaign_id) {
    const std::string theirs =
        fmt::format("this worker belongs to campaign '{}', this master serves ", Shorten(hello.campaign_id));
    return Refusal{fmt::format("{}campaign '{}'", theirs, identity.campaign_id), theirs + "another"};
  }
  if (const auto difference = proto::FirstDifference(identity.golden_hashes, hello.golden_hashes)) {
    if (!difference->offered) {
      return SameForAll(
          fmt::format("this worker was built without the controller '{}', which the campaign uses",
                      difference->controller));
    }
    if (difference->controller.starts_with(controllers::command::kGoldenPrefix))
      return SameForAll(
          "the campaign's probe prints something else on this worker's machine than where the campaign was "
          "begun, "
          "so the program may be another version there: compare what the command `probe` of the experiment "
          "prints");
    const std::string theirs =
        fmt::format("this worker's golden hash of controller '{}' is {:016x}, the campaign's is ",
                    difference->controller, *difference->offered);
    constexpr const char* kSoWhat =
        ": the same runs end differently on its machine, so its results cannot be mixed with the others";
    return Refusal{fmt::format("{}{:016x}{}", theirs, difference->needed, kSoWhat),
                   fmt::format("{}another{}", theirs, kSoWhat)};
  }
  if (hello.instance_id == 0) return SameForAll("this worker has instance id 0; it must be a random number");
  if (hello.slots < 1 || hello.slots > kMaxSlots) {
    return SameForAll(fmt::format("this worker has {} slots; 1 to {} are possible", hello.slots, kMaxSlots));
  }
  return std::nullopt;
}

}  // namespace gauntlet
