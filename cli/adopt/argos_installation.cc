#include "cli/adopt/argos_installation.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "base/printable.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "base/system/process_call.h"
#include "cli/adopt/recorder_source.h"
#include "cli/compiler.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

std::string Variable(const char* name, const char* otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : value;
}

// What pkg-config says of ARGoS and of Lua, which its headers include; nothing where it knows neither.
std::vector<std::string> PackageFlags(const std::string& prefix) {
  std::vector<std::string> flags = {"-I" + prefix + "/include"};
  for (const char* package : {"argos3_simulator", "lua5.3", "lua5.4", "lua"}) {
    const Result<CallOutput> asked = CallProcess({"pkg-config", "--cflags-only-I", package}, "", {});
    if (!asked || asked->exit_code != 0) continue;
    for (const std::string& flag : Split(Trimmed(asked->out), ' '))
      if (!flag.empty()) flags.push_back(flag);
  }
  return flags;
}

}  // namespace

Result<ArgosInstallation> FindArgos() {
  std::error_code failed;
  for (const std::string& folder : Split(Variable("PATH", "/usr/local/bin:/usr/bin:/bin"), ':')) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / "argos3";
    if (!fs::is_regular_file(program, failed)) continue;
    const fs::path real = fs::canonical(program, failed);
    const std::string prefix = real.parent_path().parent_path();
    if (!fs::exists(fs::path(prefix) / "include/argos3/core", failed)) {
      return InvalidInput(
          fmt::format("{}: its headers are not in {}/include/argos3, and the recorder of robots is "
                      "compiled against them: install ARGoS with 'make install'",
                      Printable(program.string()), Printable(prefix)));
    }
    return ArgosInstallation{.program = fs::absolute(program, failed), .prefix = prefix};
  }
  return InvalidInput(
      "there is no argos3 in PATH: install ARGoS3, or extend PATH by the folder of its programs");
}

Status CompileRecorder(const ArgosInstallation& argos, const std::string& file, std::ostream& said) {
  const std::string source = file + ".cpp";
  TRY(ReplaceFile(source, kRecorderSource, kReadableByAll));
  std::vector<std::string> arguments = {"-std=c++17", "-O2", "-fPIC", "-shared", source, "-o", file};
  for (const std::string& flag : PackageFlags(argos.prefix)) arguments.push_back(flag);
  const Status compiled = RunCompiler(std::move(arguments), "the recorder of robots", said);
  std::error_code ignored;
  fs::remove(source, ignored);
  if (compiled || compiled.error().kind != ErrorKind::kInvalidInput) return compiled;
  return InvalidInput(
      fmt::format("{}. It is compiled against the ARGoS in {}, which may be too old; or the "
                  "headers of Lua may be missing",
                  compiled.error().message, Printable(argos.prefix)));
}

}  // namespace gauntlet
