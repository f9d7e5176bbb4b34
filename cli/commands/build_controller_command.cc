// gauntlet build-controller: sources of controllers, written for ARGoS or for Gauntlet, become a plug-in.
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/printable.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "base/system/program_path.h"
#include "base/system/temporary_folder.h"
#include "cli/commands.h"
#include "cli/compiler.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "controllers/rows/plugin_rows.h"
#include "master/directory/plugins.h"
#include "search/cases/argos_controllers.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFile = std::size_t{16} << 20;  // bytes of an .argos file

struct BuildControllerOptions {
  std::vector<std::string> sources;
  std::vector<std::string> include_folders;
  std::vector<std::string> definitions;
  std::string argos;
  std::string output;
  std::string table;
  bool dry_run = false;
};

Result<std::string> ReadTable(CommandContext& context, const std::string& argos) {
  TRY(const std::string text, ReadSmallFile(argos, kMostFile));
  Result<std::string> table = ArgosControllerTable(text, argos);
  if (table && HasLoopFunctions(text)) {
    PrintMessage(context,
                 fmt::format("{} has loop functions, which Gauntlet does not run: a controller that gets "
                             "something from them, such as a pointer or a target, goes without",
                             Printable(argos)));
  }
  return table;
}

Status CheckBuildOptions(const BuildControllerOptions& options) {
  if (!options.table.empty()) {
    return options.argos.empty() ? InvalidInput("--table needs the file that it is made of: --argos FILE")
                                 : Status(Ok{});
  }
  if (options.dry_run && !options.argos.empty())
    return InvalidInput(
        "--dry-run does without --argos: write the file's parameters by --table table.cc first, "
        "and name table.cc among the sources");
  if (options.sources.empty()) return InvalidInput("which sources? name one or more C++ files");
  if (options.output.empty()) return InvalidInput("where to? say -o libNAME.so");
  std::error_code error;
  for (const std::string& source : options.sources) {
    if (source.ends_with(".lua"))
      return InvalidInput(
          fmt::format("{}: Gauntlet's own engine runs controllers in C++. One in Lua runs in ARGoS itself: "
                      "gauntlet adopt FILE.argos",
                      Printable(source)));
    if (!fs::is_regular_file(source, error)) {
      return InvalidInput(fmt::format("{}: there is no such source file", Printable(source)));
    }
  }
  for (const std::string& folder : options.include_folders) {
    if (!fs::is_directory(folder, error))
      return InvalidInput(fmt::format("{}: there is no such folder", Printable(folder)));
  }
  return Ok{};
}

// Sources for Gauntlet say what they export; for those that were written for ARGoS it is added.
Result<bool> ExportsItself(const std::vector<std::string>& sources) {
  for (const std::string& source : sources) {
    TRY(const std::string text, ReadSmallFile(source, kMostFile));
    for (const char* macro : {"GAUNTLET_PLUGIN(", "GAUNTLET_SCENARIO_PLUGIN("})
      if (text.find(macro) != text.npos) return true;
  }
  return false;
}

// What follows the compiler's name in the call that makes the plug-in.
Result<std::vector<std::string>> CallOf(const BuildControllerOptions& options,
                                        std::vector<std::string> sources) {
  const std::string prefix = fs::path(MasterProgramPath()).parent_path().parent_path();
  const Result<std::string> flags = ReadSmallFile(prefix + "/share/gauntlet/plugin.flags", kMostFile);
  if (!flags) return InvalidInput(flags.error().message + ": it comes with every build and every release");
  TRY(const bool exports, ExportsItself(sources));
  if (!exports) sources.push_back(prefix + "/share/gauntlet/plugin_main.cc");
  std::vector<std::string> call;
  for (const std::string& line : Split(*flags, '\n')) {
    if (line == "SOURCES") {
      for (const std::string& folder : options.include_folders) call.push_back("-I" + folder);
      for (const std::string& definition : options.definitions) call.push_back("-D" + definition);
      for (const std::string& source : sources) call.push_back(fs::absolute(source));
    } else if (const std::size_t at = line.find("$SDK"); at != line.npos) {
      call.push_back(line.substr(0, at) + prefix + line.substr(at + 4));
    } else if (!line.empty()) {
      call.push_back(line);
    }
  }
  call.insert(call.end(), {"-o", fs::absolute(options.output)});
  return call;
}

Status Build(CommandContext& context, const BuildControllerOptions& options, const std::string& table) {
  const TemporaryFolder scratch("build");
  if (scratch.path().empty()) return Error{ErrorKind::kIo, "no folder can be made in $TMPDIR or /tmp"};
  std::vector<std::string> sources = options.sources;
  if (!table.empty()) {
    sources.push_back(scratch.path() + "/table.cc");
    TRY(WriteOutputFile(sources.back(), table));
  }
  // What stands there is replaced by what can be used alone.
  BuildControllerOptions here = options;
  here.output = scratch.path() + "/" + fs::path(options.output).filename().string();
  TRY(std::vector<std::string> call, CallOf(here, std::move(sources)));
  TRY(RunCompiler(std::move(call), "the plug-in", context.err));
  const Result<std::string> usable = AddPluginFile(here.output);
  if (!usable) return usable.error();
  TRY(const std::string library, ReadSmallFile(here.output, controllers::kMaxPluginBytes));
  return WriteOutputFile(options.output, library);
}

Result<ExitCode> RunBuildController(CommandContext& context, const BuildControllerOptions& options) {
  TRY(CheckBuildOptions(options));
  std::string table;
  if (!options.argos.empty()) {
    TRY(table, ReadTable(context, options.argos));
  }
  if (options.dry_run) {
    TRY(const std::vector<std::string> call, CallOf(options, options.sources));
    context.out << CompilerCall(call) << '\n';
    return kExitDone;
  }
  const std::string& written = options.table.empty() ? options.output : options.table;
  TRY(options.table.empty() ? Build(context, options, table) : WriteOutputFile(options.table, table));
  PrintMessage(context, fmt::format("wrote {}", Printable(written)));
  return kExitDone;
}

}  // namespace

void AddBuildController(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("build-controller", "make a plug-in from controllers written in C++", RunBuildController);
  command.add_option("SOURCE", options.sources,
                     "C++ sources: foot-bot controllers of ARGoS, unchanged, or plug-ins (sdk/README.md)");
  AddValue(command, "--argos", "F", options.argos,
           "take devices and parameters from the <controllers> of this file");
  AddValue(command, "-o,--output", "F", options.output, "file of the plug-in, such as libmine.so");
  AddValue(command, "-I,--include", "DIR", options.include_folders, "a folder of headers; repeatable");
  AddValue(command, "-D,--define", "NAME[=VALUE]", options.definitions,
           "a macro that the sources' own build defines, such as GIT_BRANCH='\"main\"'; repeatable");
  AddValue(command, "--table", "F", options.table,
           "build nothing; write the parameters of the --argos file as C++, for a build of your own");
  command.add_flag("--dry-run", options.dry_run,
                   "print the call of the compiler that makes the plug-in, and end");
  command.footer(
      R"(Compiles the sources with one call of the compiler (c++, or the one that CXX names: g++ 10 or later), against
Gauntlet's own headers of the ARGoS interface, whose argos/README.md lists what these offer, and those of its SDK.
With --argos, every numeric attribute below <params> becomes a parameter: its name is its path, and its default is
the value in the file. Without --argos, controllers of ARGoS have no parameters and get the devices that they ask
for in Init. Eigen is needed; Gauntlet's package contains it.

Examples:
  gauntlet build-controller footbot.cpp --argos experiment.argos -o libmine.so
  gauntlet list --plugin libmine.so
  gauntlet evolve flocking --set scenario=light-flocking --plugin libmine.so --set controller=my_controller
      --set controller_parameters.wheel_turning.max_speed=8)");
}

}  // namespace gauntlet
