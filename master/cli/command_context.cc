#include "master/cli/command_context.h"

#include "base/printable.h"
#include "master/cli/table.h"

namespace gauntlet::master {

void PrintMessage(CommandContext& context, std::string_view message) {
  context.err << "gauntlet: " << Printable(message) << std::endl;
}

ExitCode Fail(CommandContext& context, const Error& error) {
  PrintMessage(context, error.message);
  switch (error.kind) {
    case ErrorKind::kInternal:
      return kExitInternal;
    case ErrorKind::kNoSpace:
      return kExitStopped;
    case ErrorKind::kInvalidInput:
    case ErrorKind::kNotFound:
    case ErrorKind::kIo:
    case ErrorKind::kCorrupt:
    case ErrorKind::kInUse:
    case ErrorKind::kVersion:
      break;
  }
  return kExitUsage;
}

}  // namespace gauntlet::master
