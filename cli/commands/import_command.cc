// gauntlet import: ARGoS' files as case files.
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/number_text.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "proto/case_json.h"
#include "search/cases/case_file.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

struct ImportOptions {
  std::vector<std::string> files;
  std::string out;
  std::string directory;
};

Status CheckImportOptions(const ImportOptions& options) {
  if (options.files.empty()) return InvalidInput("which files? gauntlet import FILE.argos... --dir DIR");
  if (options.out.empty() == options.directory.empty())
    return InvalidInput("where to? Either --out CASE.json, of one file, or --dir DIR, of any number");
  if (!options.out.empty() && options.files.size() > 1)
    return InvalidInput(
        fmt::format("--out {}: {} files want a directory, --dir DIR", options.out, options.files.size()));
  std::set<std::string> names;
  for (const std::string& file : options.files) {
    if (fs::path(file).extension() != ".argos" && fs::path(file).extension() != ".xml")
      return InvalidInput(fmt::format("{}: only .argos (or .xml) files are imported", file));
    if (!names.insert(fs::path(file).stem().string()).second)
      return InvalidInput(fmt::format("{}: there is another file of that name, and both would become {}.json",
                                      file, fs::path(file).stem().string()));
  }
  return Ok{};
}

struct CaseFile {
  std::string name;
  std::string text;
};

// All of them or none. What was changed and ignored is printed.
Result<std::vector<CaseFile>> ReadCases(CommandContext& context, const std::vector<std::string>& files) {
  std::vector<CaseFile> cases;
  for (const std::string& file : files) {
    TRY(const LoadedCase loaded, LoadCase(file));
    if (!loaded.notice.empty()) PrintMessage(context, Printable(fmt::format("{}: {}", file, loaded.notice)));
    cases.push_back({fs::path(file).stem().string() + ".json", proto::WriteCaseJson(loaded.test_case)});
  }
  return cases;
}

Result<std::uint64_t> WriteCases(const std::vector<CaseFile>& cases, const std::string& directory) {
  for (const CaseFile& one : cases) {
    TRY(WriteOutputFile(directory + "/" + one.name, one.text));
  }
  return cases.size();
}

Result<ExitCode> RunImport(CommandContext& context, const ImportOptions& options) {
  TRY(CheckImportOptions(options));
  TRY(const std::vector<CaseFile> cases, ReadCases(context, options.files));
  if (!options.out.empty()) {
    TRY(WriteOutputFile(options.out, cases.front().text));
    PrintMessage(context, fmt::format("wrote {}", Printable(options.out)));
    return kExitDone;
  }
  TRY(const std::uint64_t written,
      WriteOutputDirectory("--dir", options.directory,
                           [&](const std::string& draft) { return WriteCases(cases, draft); }));
  PrintMessage(context, fmt::format("wrote {} case {} into {}", written, Plural(written, "file"),
                                    Printable(options.directory)));
  return kExitDone;
}

}  // namespace

void AddImport(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("import", "make case files from ARGoS experiment files", RunImport);
  command.add_option("FILE", options.files, "ARGoS3 experiment files (.argos)");
  AddValue(command, "--dir", "DIR", options.directory,
           "the new directory to write to, one .json file for each FILE");
  AddValue(command, "--out", "CASE.json", options.out, "the file to write to, for a single FILE");
  command.footer(
      R"(Takes the arena, its walls and boxes, the foot-bots, and their start poses or the area in which they start.
For each file it names what it has changed, such as movable or low boxes, and what it has ignored: controllers,
loop functions, lamps and the floor, which the scenario defines here. From a file that 'export' wrote, it makes
the same case with the same start poses. It takes no seed, because a seed belongs to a run. When a file cannot be
read, the message names the place in the file, and nothing is written.

Examples:
  gauntlet import env1.argos --out env1.json && gauntlet evaluate flocking --case env1.json --replicates 20
  gauntlet import argos-cases/*.argos --dir cases
  gauntlet evaluate flocking --case env1.argos    # works without import too)");
}

}  // namespace gauntlet
