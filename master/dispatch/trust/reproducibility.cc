#include "master/dispatch/trust/reproducibility.h"
#include "proto/run_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gauntlet {
namespace {

std::string NameOf(const std::string& host) {
  return host.empty() ? "an unknown host" : host;
}

}  // namespace

bool Reproducibility::Check(proto::RunId run, const std::string& host) {
  if (state_ != Reproducible::kUnknown || begun_ == kChecks) return false;
  ++begun_;
  open_.emplace(run, host);
  return true;
}

void Reproducibility::Same(proto::RunId run, const std::string& host) {
  const auto checked = open_.extract(run);
  if (checked.empty() || state_ != Reproducible::kUnknown) return;
  hosts_.insert({NameOf(checked.mapped()), NameOf(host)});
  if (++same_ < kChecks) return;
  state_ = Reproducible::kYes;
  news_ = {state_, fmt::format("host{} {}", hosts_.size() == 1 ? "" : "s", fmt::join(hosts_, ", "))};
}

void Reproducibility::Differs(proto::RunId run, const std::string& host) {
  open_.erase(run);
  if (state_ == Reproducible::kNo) return;
  state_ = Reproducible::kNo;
  news_ = {state_, fmt::format("run {} ended differently when it was simulated again on {}",
                               proto::RunText(run), NameOf(host))};
}

}  // namespace gauntlet
