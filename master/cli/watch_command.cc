// gauntlet watch: the status every second.
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/options.h"
#include "master/cli/status_text.h"
#include "master/cli/stop_signal.h"

namespace gauntlet::master {
namespace {

struct WatchOptions {
  std::string directory;
};

ExitCode RunWatch(CommandContext& context, const WatchOptions& options) {
  constexpr int kMilliseconds = 1000;
  const StopSignal handlers(/*announced=*/false);  // ends this command, not the campaign
  while (true) {
    const Result<bool> lives = context.campaigns.MasterLives(options.directory);
    if (!lives) return Fail(context, lives.error());
    const Result<std::string> text = CurrentStatus(context, options.directory, /*json=*/false);
    if (!text) return Fail(context, text.error());
    // The screen is cleared on a terminal; elsewhere the states follow each other.
    context.out << (context.out_is_terminal ? "\x1b[H\x1b[2J" : "") << *text << std::flush;
    if (!*lives || StopSignal::ComesWithin(kMilliseconds)) return kExitDone;
  }
}

}  // namespace

void AddWatch(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("watch", "the status every second, until the campaign's master ends", RunWatch);
  AddDirectory(command, options.directory);
  command.footer("Example:\n  gauntlet watch DIR");
}

}  // namespace gauntlet::master
