// A real Slurm on this machine for tests (tests/slurm/slurm-cluster), and submitted campaigns on it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/integration/campaign_driver.h"
#include "tests/support/process.h"

namespace gauntlet::testing_support {

// Its daemons end with the object, and with this process should it be killed.
class SlurmCluster {
 public:
  // Why Slurm cannot be had on this machine; "" when it can.
  static std::string WhyMissing();

  // `options` of `slurm-cluster start`. Sets SLURM_CONF in this process' environment.
  explicit SlurmCluster(const std::vector<std::string>& options);
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;
  ~SlurmCluster();

  // slurm-cluster COMMAND...: node-kill, node-start, ctl-stop, ctl-start.
  void Do(const std::vector<std::string>& command) const;

 private:
  ProcessResult Script(const std::vector<std::string>& arguments) const;

  TemporaryDirectory directory_;
  FILE* guardian_ = nullptr;
};

// stdout of a Slurm command, found in PATH.
std::string Slurm(const std::vector<std::string>& command);
// "ID STATE NAME" of the jobs that squeue shows, all users'.
std::vector<std::string> QueueLines(const std::vector<std::string>& options = {});

// Tests with a cluster of their own; skipped where there is no Slurm.
class SlurmTest : public testing::Test {
 protected:
  void SetUp() override;
  void StartCluster(const std::vector<std::string>& options) {
    cluster_ = std::make_unique<SlurmCluster>(options);
  }

  std::string dir() const { return scratch_ / "c"; }
  // gauntlet submit of the campaign into dir(), on the loopback device.
  std::vector<std::string> SubmitArguments(const SmallCampaign& campaign, const std::string& master,
                                           const std::vector<std::string>& settings = {}) const;
  // The setting for workers that take `milliseconds` longer for each run (and no more CPU time).
  static std::string SlowWorkers(int milliseconds);

  // state_hash of the same campaign on a local pool.
  std::string LocalHash(const SmallCampaign& campaign) const;
  nlohmann::json Status() const;
  bool StatusBecomes(const std::function<bool(const nlohmann::json&)>& condition,
                     std::chrono::seconds patience = std::chrono::seconds(90)) const;
  // No job is left within the time that Slurm needs to end one.
  static bool QueueEmpties();

  TemporaryDirectory scratch_;
  std::unique_ptr<SlurmCluster> cluster_;
};

}  // namespace gauntlet::testing_support
