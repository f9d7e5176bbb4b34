#include "tests/integration/lying_workers_drill.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

constexpr std::uint64_t kFirstLiar = 0x11a0;
constexpr std::uint64_t kFirstHonest = 0x50;

}  // namespace

void EvolveWithLiars(const SmallCampaign& campaign, const std::string& dir, const std::vector<Lie>& liars,
                     bool all_named) {
  const std::string& hash = UndisturbedHash(campaign);
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(campaign, dir));
  ASSERT_TRUE(Serves(dir)) << master->Err();
  std::vector<std::unique_ptr<Liar>> workers;
  for (const Lie lie : liars)
    workers.push_back(std::make_unique<Liar>(dir, lie, kFirstLiar + workers.size()));
  for (std::size_t i = 0; i < liars.size(); ++i)
    workers.push_back(std::make_unique<Liar>(dir, Lie::kNone, kFirstHonest + i));
  for (const auto& worker : workers) EXPECT_TRUE(worker->joined());
  const ProcessResult result = master->Wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(StateHash(dir), hash);
  const std::string log = MasterLog(dir);
  EXPECT_THAT(log, testing::Not(testing::HasSubstr("run-given-up")));
  EXPECT_FALSE(Show(dir).value("nondeterministic", true));
  for (std::size_t i = 0; i < liars.size(); ++i) {
    const std::string name = fmt::format("{:016x}@scripted", kFirstLiar + i);
    fmt::print("{}: {} leases\n", NameOf(liars[i]), workers[i]->leases());
    if (!all_named || liars[i] == Lie::kSlow) continue;
    EXPECT_THAT(log, testing::HasSubstr("worker " + name + " is quarantined")) << NameOf(liars[i]);
  }
}

}  // namespace gauntlet::testing_support
