#include "controllers/partitioning/partitioning_record.h"

namespace gauntlet::controllers {
namespace {

// Hand-overs of a run that are kept with their places; more are only counted. Memory, not behaviour.
constexpr std::size_t kMostTransfers = 4000;

bool Engaged(HandoverStep step) {
  return step == HandoverStep::kGrant || step == HandoverStep::kRelease;
}

}  // namespace

void PartitioningRecord::Begin(int robots, PartitioningState state, sim::Tick tick_limit) {
  robots_.assign(static_cast<std::size_t>(robots), {.state = state});
  length_in_window_.assign(FoodCount::Windows(tick_limit), 0.0);
  transfers_.reserve(kMostTransfers);
}

void PartitioningRecord::Hear(sim::Tick tick, std::span<const sim::Signals> signals) {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    robots_[i].at_rest = false;
    const PartitionMessage message = DecodePartition(signals[i].message);
    if (message.from_robot) Hear(message, robots_[i]);
  }
  length_in_window_[FoodCount::WindowOf(tick)] = MeanLength();
}

void PartitioningRecord::Hear(const PartitionMessage& message, Robot& robot) {
  constexpr auto kWait = PartitioningState::kWaitForTransfer;
  if (message.state == kWait && robot.state != kWait) ++waits_;
  if (message.state == PartitioningState::kGoToNest && robot.state == kWait) ++timeouts_;
  if (message.state == kWait) {
    Engaged(message.step) ? ++transferring_ : ++waited_;
    if (Engaged(robot.step) && message.step == HandoverStep::kOffer) ++broken_;
  }
  robot.state = message.state;
  robot.step = message.step;
  robot.length = message.partition_length;
  robot.at_rest = message.state == kWait || message.step != HandoverStep::kNone;
}

void PartitioningRecord::HandOver(const Transfer& transfer) {
  ++handed_over_;
  if (transfers_.size() < kMostTransfers) transfers_.push_back(transfer);
}

double PartitioningRecord::MeanLength() const {
  double sum = 0.0;
  for (const Robot& robot : robots_) sum += robot.length;
  return sum / static_cast<double>(robots_.size());
}

void PartitioningRecord::AddMetrics(int trapped, std::vector<std::pair<std::string, double>>& metrics) const {
  const double none = -1.0;
  metrics.insert(metrics.end(),
                 {{"transfers", handed_over_},
                  {"broken_transfers", broken_},
                  {"waits", waits_},
                  {"wait_timeouts", timeouts_},
                  {"mean_waiting_time", waits_ == 0 ? none : waited_ * sim::kTickSeconds / waits_},
                  {"transfer_time", transferring_ * sim::kTickSeconds},
                  {"trapped_robots", trapped},
                  {"partition_length", MeanLength()}});
}

void PartitioningRecord::AddWindows(std::vector<std::pair<std::string, double>>& metrics) const {
  for (std::size_t i = 0; i < length_in_window_.size(); ++i) {
    metrics.emplace_back("partition_length_window_" + std::to_string(i + 1), length_in_window_[i]);
  }
}

}  // namespace gauntlet::controllers
