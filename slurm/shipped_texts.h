// The files of this folder that the program needs, as texts, so that it finds them wherever it stands.
#pragma once

#include <array>
#include <string_view>

namespace gauntlet::slurm {

struct ShippedText {
  std::string_view name;
  std::string_view text;
};
extern const std::array<ShippedText, 4> kShippedClusters;

// What stands for @RUN@ in a job's script.
extern const std::string_view kRunJob;

}  // namespace gauntlet::slurm
