// What every command prints, held against goldens/ line by line (goldens/README.md).
// Covers: cli/baseline_run.cc, cli/commands/corpus_command.cc, cli/commands/master_command.cc,
// cli/commands/margin_command.cc, cli/commands/question_commands.cc, cli/commands/resume_command.cc,
// cli/commands/show_command.cc, cli/commands/status_command.cc, cli/commands/stop_command.cc, cli/dry_run.cc,
// cli/output/output_file.cc, cli/output/standard_output.cc, cli/run_campaign.cc
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/golden.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;

const std::string kGoldens = "tests/cli/goldens";

// Names of the goldens without ".txt", as in "help/evolve".
std::vector<std::string> Goldens() {
  const fs::path root = fs::path(GAUNTLET_SOURCE_DIR) / kGoldens;
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".txt") continue;
    names.push_back(fs::relative(entry.path(), root).replace_extension());
  }
  std::ranges::sort(names);
  return names;
}

void ReplaceAll(std::string& text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

// What is not the same in every run of a command and on every machine gets a name in angle brackets; the
// README lists these rules.
std::string Stable(std::string text, const std::string& scratch) {
  ReplaceAll(text, scratch, "<here>");
  ReplaceAll(text, GAUNTLET_BINARY_DIR, "<programs>");
  ReplaceAll(text, GAUNTLET_SOURCE_DIR, "<source>");
  ReplaceAll(text, GAUNTLET_VERSION, "<version>");
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  static const std::vector<std::pair<std::regex, std::string>> rules = {
      {std::regex(R"(20\d\d-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d+)?)?Z?)"), "<time>"},
      {std::regex(R"(20\d\d\d\d\d\dT\d\d\d\d\d\dZ)"), "<time>"},
      {std::regex(R"(( runs? in ).*; workers idle .*)"), "$1<duration and speed>"},
      {std::regex(R"(about \S+ core hours|they take about .*)"), "<duration>"},
      {std::regex(R"((took |a run takes |re-simulations |\d +|\d \| )\d+\.\d s\b)"), "$1<duration>"},
      {std::regex(R"re("((\w+_)?seconds|bytes|attempt)": [0-9.e+-]+)re"), "\"$1\": <measured>"},
      {std::regex(fmt::format("[0-9a-f]{{16}}@{}", host)), "<worker>"},
      {std::regex(R"(,[0-9.e-]+,([0-9a-f]{16}),<worker>,\d+)"), ",<measured>,$1,<worker>,<measured>"},
      {std::regex(R"(commit .*, compiled by .*)"), "commit <commit>, compiled by <compiler>"},
      {std::regex(R"(this machine has \d+)"), "this machine has <cores>"},
      {std::regex(R"(gauntlet-abc-[0-9a-f]{6}-)"), "gauntlet-abc-<hash>-"},
      {std::regex(R"(127\.0\.0\.1:\d{4,5}\b)"), "127.0.0.1:<port>"},
  };
  for (const auto& [what, with] : rules) text = std::regex_replace(text, what, with);
  return text;
}

// Every line with `mark` in front.
std::string Marked(const std::string& text, const std::string& mark) {
  std::string marked;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    marked += (line.empty() ? mark.substr(0, mark.find(' ')) : mark + line) + "\n";
  if (!text.empty() && text.back() != '\n') marked += "(no end of line)\n";
  return marked;
}

// The campaigns, the study and the corpus that all commands are asked about. CTest makes them once.
std::string Data() {
  if (const char* made = std::getenv("GAUNTLET_GOLDEN_DATA")) return made;
  static const TemporaryDirectory data;
  static const ProcessResult made =
      RunProcess({GAUNTLET_SOURCE_DIR "/tests/cli/goldens/make_data", GAUNTLET_BINARY_DIR, data.path()});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  return data.path();
}

class CommandGoldens : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { fs::copy(Data(), Here(), fs::copy_options::recursive); }
  std::string Here() const { return scratch_ / "here"; }

  std::string Answer(const std::string& line) const {
    const ProcessResult result =
        RunProcess({"/usr/bin/env", "-C", Here(), "bash", "-c", line},
                   {"PATH=" GAUNTLET_BINARY_DIR ":" + Here() + "/bin:/usr/local/bin:/usr/bin:/bin",
                    "HOME=" + Here() + "/home", "LC_ALL=C.UTF-8", "S=" GAUNTLET_SOURCE_DIR});
    return Stable(Marked(result.out, "  ") + Marked(result.err, "! "), Here()) +
           (result.exit_code == 0 ? "" : fmt::format("exit {}\n", result.exit_code));
  }

 private:
  TemporaryDirectory scratch_;
};

TEST_P(CommandGoldens, SayWhatIsPrinted) {
  const std::string file = fmt::format("{}/{}.txt", kGoldens, GetParam());
  std::ifstream golden(fs::path(GAUNTLET_SOURCE_DIR) / file);
  std::string found;
  for (std::string line; std::getline(golden, line);) {
    if (line.starts_with("#")) found += line + "\n";
    if (line.starts_with("$ ")) found += line + "\n" + Answer(line.substr(2));
  }
  ExpectGolden(file, found);
}

INSTANTIATE_TEST_SUITE_P(Command, CommandGoldens, testing::ValuesIn(Goldens()),
                         [](const testing::TestParamInfo<std::string>& golden) {
                           std::string name = golden.param;
                           std::ranges::replace_if(
                               name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

TEST(CommandGoldensList, HasEveryCommandAndItsHelp) {
  std::istringstream help(RunProcess({GAUNTLET_BINARY_DIR "/gauntlet", "help"}).out);
  const std::vector<std::string> goldens = Goldens();
  const std::regex row("  ([a-z][a-z-]+)  .*");
  std::size_t commands = 0;
  bool listed = false;
  for (std::string line; std::getline(help, line) && !line.starts_with("Start here");) {
    listed = listed || line == "Subcommands:";
    std::smatch name;
    if (!listed || !std::regex_match(line, name, row)) continue;
    ++commands;
    EXPECT_THAT(goldens, testing::IsSupersetOf({name[1].str(), "help/" + name[1].str()}));
  }
  EXPECT_GE(commands, 26U);
}

}  // namespace
}  // namespace gauntlet::testing_support
