// gauntlet: the master and the command line.
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "master/cli/command_line.h"

namespace {

// How a person who reads a hint can start this program again.
std::string ProgramName(const char* first_argument) {
  if (const char* given = std::getenv("GAUNTLET_PROGRAM"); given != nullptr && *given != '\0') return given;
  const std::string_view name = first_argument;
  return name.find('/') == std::string_view::npos ? "gauntlet" : std::string(name);
}

}  // namespace

int main(int argc, char** argv) {
  gauntlet::master::CommandContext context{.out = std::cout,
                                           .err = std::cerr,
                                           .err_is_terminal = isatty(STDERR_FILENO) == 1,
                                           .out_is_terminal = isatty(STDOUT_FILENO) == 1,
                                           .program = ProgramName(argc > 0 ? argv[0] : "gauntlet"),
                                           .service = {}};
  return gauntlet::master::RunCommandLine(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc),
                                          context);
}
