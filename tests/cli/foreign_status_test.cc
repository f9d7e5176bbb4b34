// status.json as anybody may have written it: a sentence, whatever its fields hold.
#include <filesystem>
#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

#include "master/campaign/campaign_status.h"
#include "master/directory/campaign_lock.h"
#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Every field that there can be.
ordered_json WholeStatus() {
  MasterView master;
  master.campaign_id = "c";
  master.host = "node7";
  BackendView backend;
  backend.allocations.push_back({"12", "RUNNING", "", "node1", 1, false});
  WorkerView& worker = backend.workers.emplace_back();
  worker.label = "w";
  worker.record.quarantined = true;
  worker.leases = {{39, 0x100000027, 1, 4.2, false}, {40, 0x100000028, 3, 4.1, true}};
  ordered_json status = ordered_json::parse(StatusJson(master, {}, backend));
  status["allocations"][0]["role"] = "workers";
  return status;
}

class ForeignStatus : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    Write("campaign.db", "");
    // This process is the campaign's living master.
    Result<std::unique_ptr<CampaignLock>> lock = CampaignLock::Acquire(Path("lock"), directory_.string());
    ASSERT_TRUE(lock.ok()) << lock.error().message;
    lock_ = *std::move(lock);
  }
  ExitCode Ask(const ordered_json& status, const std::vector<std::string>& options = {}) {
    Write("status.json", status.dump());
    out_.str("");
    err_.str("");
    CommandContext context{.out = out_, .err = err_};
    std::vector<std::string> arguments = {"status", directory_.string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return RunCommandLine(arguments, context);
  }
  // Refused with the place and in one line.
  void ExpectRefused(const ordered_json& status, const std::string& place) {
    for (const std::vector<std::string>& options : {std::vector<std::string>(), {"--json"}}) {
      EXPECT_EQ(Ask(status, options), kExitUsage) << place << " " << out_.str();
      const std::string text = err_.str();
      EXPECT_THAT(text, AllOf(HasSubstr(Path("status.json")), HasSubstr(place))) << status.dump();
      EXPECT_EQ(std::ranges::count(text, '\n'), 1) << text;
      EXPECT_THAT(out_.str(), IsEmpty());
    }
  }

  std::unique_ptr<CampaignLock> lock_;
};

TEST_F(ForeignStatus, AMastersOwnIsShown) {
  EXPECT_EQ(Ask(WholeStatus()), kExitDone) << err_.str();
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("on node7"), HasSubstr("39 (4.2 s), 40 (next, attempt 3)")));
}

TEST_F(ForeignStatus, NoFieldOfAnotherTypeIsAnInternalError) {
  const std::vector<ordered_json> wrong = {nullptr,
                                           true,
                                           "x",
                                           "\x1b[31m",
                                           -1,
                                           1.5,
                                           1e300,
                                           0,
                                           18446744073709551615U,
                                           ordered_json::array(),
                                           ordered_json::array({nullptr}),
                                           ordered_json::object(),
                                           {{"x", 1}}};
  const ordered_json whole = WholeStatus();
  std::vector<ordered_json::json_pointer> places;
  const std::function<void(const ordered_json&, const ordered_json::json_pointer&)> collect =
      [&](const ordered_json& value, const ordered_json::json_pointer& place) {
        places.push_back(place);
        for (const auto& [key, child] : value.items())
          if (value.is_structured()) collect(child, value.is_array() ? place / std::stoul(key) : place / key);
      };
  collect(whole, ordered_json::json_pointer());
  ASSERT_GT(places.size(), 70U);
  int refused = 0;
  int shown = 0;
  for (const ordered_json::json_pointer& place : places) {
    for (const ordered_json& value : wrong) {
      ordered_json status = whole;
      status[place] = value;
      const ExitCode code = Ask(status);
      EXPECT_TRUE(code == kExitDone || code == kExitUsage) << place << " = " << value << ": " << err_.str();
      (code == kExitDone ? shown : refused)++;
      EXPECT_EQ(out_.str().find('\x1b'), std::string::npos) << place;
      EXPECT_EQ(err_.str().find('\x1b'), std::string::npos) << place;
    }
    if (place.empty()) continue;
    ordered_json status = whole;
    ordered_json& parent = status[place.parent_pointer()];
    if (parent.is_object()) parent.erase(place.back());
    const ExitCode code = Ask(status);
    EXPECT_TRUE(code == kExitDone || code == kExitUsage) << "without " << place << ": " << err_.str();
  }
  EXPECT_GT(refused, 200);
  EXPECT_GT(shown, 200) << "what nobody reads may be anything";
}

TEST_F(ForeignStatus, ARefusalNamesThePlaceAndWhatBelongsThere) {
  const auto with = [](const char* place, const ordered_json& value) {
    ordered_json status = WholeStatus();
    status[ordered_json::json_pointer(place)] = value;
    return status;
  };
  ExpectRefused(with("/unix_ms", "noon"), "unix_ms is string, where a count belongs");
  ExpectRefused(with("/runs_done", -1), "runs_done is number, where a count belongs");
  ExpectRefused(with("/master/pid", nullptr), "master.pid is null, where a count belongs");
  ExpectRefused(with("/worker_list/0/runs/1/seconds", "x"),
                "worker_list[0].runs[1].seconds is string, where a number belongs");
  ExpectRefused(with("/worker_list/0/runs/1", 7), "worker_list[0].runs[1] is no object");
  ExpectRefused(with("/allocations/0/nodes", 7), "allocations[0].nodes is number, where a text belongs");
  ordered_json without = WholeStatus();
  without.erase("worker_list");
  ExpectRefused(without, "worker_list is missing, where a list belongs");
  ExpectRefused(ordered_json::array(), "does not parse");
}

}  // namespace
}  // namespace gauntlet
