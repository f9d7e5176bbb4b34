// gauntlet build-controller: sources of controllers that were written for ARGoS become a plug-in.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/printable.h"
#include "base/system/atomic_file.h"
#include "base/system/process_call.h"
#include "base/system/program_path.h"
#include "base/system/temporary_folder.h"
#include "cli/build_errors.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
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
  std::string sdk;
};

// As an argument of CMake, whatever bytes it holds.
std::string Quoted(const std::string& text) {
  return fmt::format("[==[{}]==]", text);
}
std::string Quoted(const fs::path& path) {
  return Quoted(fs::absolute(path).lexically_normal().string());
}

std::string ProjectText(const BuildControllerOptions& options, bool with_table) {
  std::string sources;
  for (const std::string& source : options.sources) sources += " " + Quoted(fs::path(source));
  std::string folders;
  for (const std::string& folder : options.include_folders) folders += " " + Quoted(fs::path(folder));
  std::string definitions;
  for (const std::string& definition : options.definitions) definitions += " " + Quoted(definition);
  const fs::path output = fs::absolute(options.output);
  return fmt::format(R"(cmake_minimum_required(VERSION 3.25)
project(controller LANGUAGES CXX)
set(CMAKE_BUILD_TYPE Release)
find_package(Gauntlet REQUIRED)
gauntlet_add_argos_plugin(controller SOURCES{}{})
target_include_directories(controller PRIVATE{})
target_compile_definitions(controller PRIVATE{})
set_target_properties(controller PROPERTIES PREFIX "" SUFFIX "" OUTPUT_NAME [==[{}]==] LIBRARY_OUTPUT_DIRECTORY {})
)",
                     sources, with_table ? " TABLE table.cc" : "", folders, definitions,
                     output.filename().string(), Quoted(output.parent_path()));
}

Status RunCMake(CommandContext& context, const std::vector<std::string>& arguments) {
  // Without any, as in some batch jobs, CMake does not find its own files.
  setenv("PATH", "/usr/local/bin:/usr/bin:/bin", /*overwrite=*/0);
  Result<CallOutput> done = CallProcess(arguments, "", {});
  if (!done && done.error().kind == ErrorKind::kNotFound) {
    return InvalidInput(
        "there is no cmake in PATH, which plug-ins are built with: install CMake 3.25 or later");
  }
  if (!done) return done.error();
  if (done->exit_code == 0) return Ok{};
  context.err << BuildErrors(done->out + done->err) << std::flush;
  return InvalidInput("the plug-in could not be built: see above");
}

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

Status FindSdk(const fs::path& prefix) {
  std::error_code error;
  for (const char* libraries : {"lib", "lib64"}) {
    if (fs::exists(prefix / libraries / "cmake/Gauntlet/GauntletConfig.cmake", error)) return Ok{};
  }
  return InvalidInput(
      fmt::format("{}: the SDK is not there: install it with 'cmake --install BUILD --prefix DIR --component "
                  "sdk' and say --sdk DIR",
                  Printable(prefix.string())));
}

Status Build(CommandContext& context, const BuildControllerOptions& options, const std::string& table) {
  const TemporaryFolder scratch("build");
  if (scratch.path().empty()) return Error{ErrorKind::kIo, "no folder can be made in $TMPDIR or /tmp"};
  if (!table.empty()) {
    TRY(WriteOutputFile(scratch.path() + "/table.cc", table));
  }
  TRY(WriteOutputFile(scratch.path() + "/CMakeLists.txt", ProjectText(options, !table.empty())));
  const std::string prefix =
      options.sdk.empty() ? fs::path(MasterProgramPath()).parent_path().parent_path().string() : options.sdk;
  TRY(FindSdk(prefix));
  const std::string build = scratch.path() + "/build";
  TRY(RunCMake(context, {"cmake", "-S", scratch.path(), "-B", build,
                         "-DCMAKE_PREFIX_PATH=" + fs::absolute(prefix).string()}));
  TRY(RunCMake(context, {"cmake", "--build", build}));
  const Result<std::string> usable = AddPluginFile(options.output);
  if (usable) return Ok{};
  std::error_code ignored;
  fs::remove(options.output, ignored);
  return usable.error();
}

Result<ExitCode> RunBuildController(CommandContext& context, const BuildControllerOptions& options) {
  TRY(CheckBuildOptions(options));
  std::string table;
  if (!options.argos.empty()) {
    TRY(table, ReadTable(context, options.argos));
  }
  const std::string& written = options.table.empty() ? options.output : options.table;
  TRY(options.table.empty() ? Build(context, options, table) : WriteOutputFile(options.table, table));
  PrintMessage(context, fmt::format("wrote {}", Printable(written)));
  return kExitDone;
}

}  // namespace

void AddBuildController(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("build-controller", "make a plug-in from controllers written for ARGoS", RunBuildController);
  command.add_option("SOURCE", options.sources, "unchanged C++ sources of foot-bot controllers");
  AddValue(command, "--argos", "F", options.argos,
           "take devices and parameters from the <controllers> of this file");
  AddValue(command, "-o,--output", "F", options.output, "file of the plug-in, such as libmine.so");
  AddValue(command, "-I,--include", "DIR", options.include_folders, "a folder of headers; repeatable");
  AddValue(command, "-D,--define", "NAME[=VALUE]", options.definitions,
           "a macro that the sources' own build defines, such as GIT_BRANCH='\"main\"'; repeatable");
  AddValue(command, "--sdk", "DIR", options.sdk,
           "folder in which the SDK was installed (default: that of this program)");
  AddValue(command, "--table", "F", options.table,
           "build nothing; write the parameters of the --argos file as C++, for CMake");
  command.footer(
      R"(Compiles the sources against Gauntlet's own headers of the ARGoS interface; argos/README.md lists what these
offer. With --argos, every numeric attribute below <params> becomes a parameter: its name is its path, and its
default is the value in the file. Without --argos, the controllers have no parameters and get the devices that
they ask for in Init. The command needs a C++ compiler, CMake and Eigen; Gauntlet's package contains Eigen.

Examples:
  gauntlet build-controller footbot.cpp --argos experiment.argos -o libmine.so
  gauntlet list --plugin libmine.so
  gauntlet evolve flocking --set scenario=light-flocking --plugin libmine.so --set controller=my_controller
      --set controller_parameters.wheel_turning.max_speed=8)");
}

}  // namespace gauntlet
