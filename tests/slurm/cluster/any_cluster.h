// Clusters other than Slurm's on this machine for tests: a real Grid Engine (tests/slurm/sge-cluster), a
// stand-in for PBS (tests/slurm/pbs_stand_in.py) and hosts with an sshd each (tests/slurm/sshd-hosts).
#pragma once

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "slurm/slurm_client.h"
#include "tests/slurm/cluster/slurm_cluster.h"

namespace gauntlet::testing_support {

// Two nodes (alpha and beta, node1 and node2) with two slots each. It ends with the object, and with this
// process should it be killed.
class AnyCluster {
 public:
  // Of "sge", "pbs", "ssh": why it cannot be had on this machine; "" when it can.
  static std::string WhyMissing(const std::string& kind);

  // Its environment becomes this process'.
  explicit AnyCluster(const std::string& kind);
  AnyCluster(const AnyCluster&) = delete;
  AnyCluster& operator=(const AnyCluster&) = delete;
  ~AnyCluster();

  // The setting that names it; with `changes`, a cluster file like it.
  std::string Setting(const std::string& changes = "");
  std::string file(const std::string& name) const { return directory_ / ("c/" + name); }
  // Commands of its script: node-kill, node-start, ctl-stop, ctl-start.
  void Do(const std::vector<std::string>& command) const;
  // What it has of this user, in its own words.
  std::vector<slurm::JobStatus> Jobs() const;
  void Cancel(const std::string& job) const;
  // All processes of the job die, and nobody says so.
  static void Kill(const std::string& job);

 private:
  std::string Base() const;
  ProcessResult Script(const std::vector<std::string>& arguments) const;
  std::unique_ptr<slurm::SlurmClient> Client() const;

  std::string kind_;
  TemporaryDirectory directory_;
  FILE* guardian_ = nullptr;
  std::map<std::string, std::string> environment_before_;
};

// A test on one of them, by its name.
class AnyClusterTest : public SlurmTest, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override;
  bool QueueEmpties() const;

  std::unique_ptr<AnyCluster> site_;
};

}  // namespace gauntlet::testing_support
