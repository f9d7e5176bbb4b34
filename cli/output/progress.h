// Progress of a campaign on stderr: a live line on a terminal, plain lines elsewhere.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "base/system/clock.h"
#include "master/campaign/campaign_status.h"

namespace gauntlet {

// One line of at most `columns` columns; what matters least is left out first.
std::string LiveProgressLine(const CampaignProgress& progress, std::size_t columns);
// "generation 3/50, runs 42/1,000 (12.3/s), best 0.250, ...", for logs.
std::string PlainProgressLine(const CampaignProgress& progress);

enum class ProgressMode { kNone, kLive, kPlain };

// Plain lines: at the start, then every 5 s, and for each new generation if the last line is a second old.
// Live: redraws the line at each update. Not thread-safe.
class ProgressPrinter {
 public:
  // `write` gets what goes to the terminal or log; `columns` is asked at each live update.
  ProgressPrinter(ProgressMode mode, const Clock& clock, std::function<void(const std::string&)> write,
                  std::function<std::size_t()> columns);

  void Update(const CampaignProgress& progress);
  // Removes the live line, or prints the last state as a plain one. Further calls do nothing.
  void Finish();

 private:
  ProgressMode mode_;
  const Clock& clock_;
  std::function<void(const std::string&)> write_;
  std::function<std::size_t()> columns_;
  std::optional<CampaignProgress> latest_;
  std::string last_line_;
  std::optional<TimePoint> last_time_;
  std::uint32_t last_generation_ = 0;
};

// What suits standard error: none when unwanted, live on a terminal that can move its cursor, else plain.
ProgressMode ChooseProgressMode(bool wanted, bool is_terminal, const char* term);
// Columns of the terminal on standard error; 80 when it is none.
std::size_t TerminalColumns();

}  // namespace gauntlet
