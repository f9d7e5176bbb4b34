// gauntlet: the master and the command line.
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "base/shell_quoted.h"
#include "base/system/resource_limits.h"
#include "base/version.h"
#include "cli/command_line.h"
#include "cli/output/standard_output.h"

namespace {

// How a person who reads a hint can start this program again.
std::string ProgramName(const char* first_argument) {
  if (const char* given = std::getenv("GAUNTLET_PROGRAM"); given != nullptr && *given != '\0')
    return gauntlet::ShellQuoted(given);
  const std::string_view name = first_argument;
  return name.find('/') == std::string_view::npos ? "gauntlet" : gauntlet::ShellQuoted(name);
}

}  // namespace

int main(int argc, char** argv) {
  gauntlet::ReserveStandardDescriptors();
  gauntlet::ExplainAborts("gauntlet");
  const gauntlet::Status prepared = gauntlet::PrepareProgram();
  std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves must not end a campaign
  gauntlet::DescriptorBuffer buffer(STDOUT_FILENO);
  std::ostream out(&buffer);
  gauntlet::CommandContext context{.out = out,
                                   .err = std::cerr,
                                   .err_is_terminal = isatty(STDERR_FILENO) == 1,
                                   .out_is_terminal = isatty(STDOUT_FILENO) == 1,
                                   .program = ProgramName(argc > 0 ? argv[0] : "gauntlet"),
                                   .version = gauntlet::VersionText("gauntlet")};
  if (!prepared) return gauntlet::Fail(context, prepared.error());
  const int code =
      gauntlet::RunCommandLine(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc), context);
  out.flush();
  // A reader that has seen enough (head) is no failure.
  if (buffer.error() == 0 || buffer.error() == EPIPE) return code;
  gauntlet::PrintMessage(context,
                         std::string("standard output: cannot be written: ") + std::strerror(buffer.error()));
  return gauntlet::kExitInternal;
}
