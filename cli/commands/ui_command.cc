// gauntlet ui: the pages of campaigns in a browser, live.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/options/stop_signal.h"
#include "master/http/http_server.h"
#include "report/ui/served_campaigns.h"
#include "report/ui/web_access.h"

namespace gauntlet {
namespace {

struct UiOptions {
  std::vector<std::string> sets;
  std::string port;
};

Result<ExitCode> RunUi(CommandContext& context, const UiOptions& options) {
  TRY(const int port, ParsePort("--port", options.port));
  TRY(const std::unique_ptr<ServedCampaigns> served, ServedCampaigns::Open(options.sets, context.campaigns));
  const StopSignal handlers(/*announced=*/false);
  const std::string token = NewToken();
  constexpr std::size_t kAnsweringThreads = 16;  // a browser keeps up to six connections open
  Result<std::unique_ptr<HttpServer>> server =
      HttpServer::Start({.port = port, .answering_threads = kAnsweringThreads},
                        [&campaigns = *served, &token](const HttpRequest& request) {
                          const Admission admission = Admit(request, token);
                          return admission.refusal ? *admission.refusal : campaigns.Answer(admission.path);
                        });
  if (!server) {
    Error error = std::move(server).error();
    if (error.kind == ErrorKind::kInUse)
      error.message += ": give --port another number, or 0 for any free one";
    return error;
  }
  context.out << AddressOf((*server)->port(), token) << "\n" << std::flush;
  PrintMessage(context, "open this address in a browser of this machine; Ctrl-C ends it");
  constexpr int kMilliseconds = 1000;
  while (!StopSignal::ComesWithin(kMilliseconds)) {
  }
  return kExitDone;
}

}  // namespace

void AddUi(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("ui", "show campaigns live in a browser, with a replay of every run", RunUi);
  command
      .add_option("DIR", options.sets,
                  "a campaign, which may be running, or the directory of a 'study' or 'tune'; the fitness of "
                  "several campaigns, or of several sets of runs as 'compare' names them, is compared")
      ->required();
  AddValue(command, "--port", "PORT", options.port, "port of 127.0.0.1 (default: any free port)");
  command.footer(
      R"(Prints an address and serves the pages of 'gauntlet report' there to a browser on this machine, until Ctrl-C.
Besides, it shows what the campaign does now: workers, throughput, time left, events, and why nothing runs. A
click on a run simulates it again. Nothing of the campaign is changed. Only those who know the whole address can
open the pages. To open them from another machine, make a tunnel: ssh -L PORT:127.0.0.1:PORT HOST.

Examples:
  gauntlet ui campaigns/flocking-20260131T120000Z
  gauntlet ui DIR --port 8080)");
}

}  // namespace gauntlet
