#include "cli/build_errors.h"

#include <cxxabi.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <regex>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/printable.h"
#include "base/split.h"

namespace gauntlet {
namespace {

constexpr std::size_t kShownErrors = 20;  // lines

struct Origin {
  const char* pattern;  // of the header's name
  const char* advice;
};

// The first one that fits counts.
constexpr Origin kOrigins[] = {
    {R"(argos3/plugins/robots/generic/control_interface/ci_quadrotor_.*)",
     "is for flying robots; robots of Gauntlet are foot-bots"},
    {R"(argos3/plugins/robots/(generic|foot-bot)/.*)",
     "is of a device that Gauntlet's foot-bot does not have; argos/README.md names those that it has"},
    {R"(argos3/plugins/robots/.*)", "is of another robot; robots of Gauntlet are foot-bots"},
    {R"(argos3/plugins/simulator/visualizations/.*|Q[A-Z]\w*|Qt\w*/.*)",
     "is for windows, and Gauntlet shows none: leave that source out; `gauntlet replay` draws runs"},
    {R"(argos3/.*)",
     "is of ARGoS' simulator, and a controller in Gauntlet has its interface alone: leave out what needs it; "
     "a scenario does what loop functions did (docs/generic-scenario.md)"},
    {R"((ros|rclcpp|tf2?|\w+_msgs|\w+_srvs)/.*)",
     "is of ROS, which no run in Gauntlet has: build the part of the controller that decides, and leave out "
     "its nodes and messages"},
    {R"(buzz/.*|kilolib\.h)",
     "is of another robot's programs; Gauntlet compiles controllers in C++ for foot-bots"},
    {R"(.*)", "was not found: name the folder that it is in by -I DIR; libraries have to be installed"},
};

std::string AdviceOn(const std::string& header) {
  const auto* const origin = std::ranges::find_if(
      kOrigins, [&](const Origin& one) { return std::regex_match(header, std::regex(one.pattern)); });
  return fmt::format("<{}> {}", Printable(header), origin->advice);
}

// Linkers name symbols as C++ writes them, or as the compiler encodes them.
std::string AdviceOnUndefined(std::string symbol) {
  int failed = 0;
  const std::unique_ptr<char, void (*)(void*)> plain(
      abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &failed), std::free);
  if (plain != nullptr && failed == 0) symbol = plain.get();
  const std::string before = symbol.substr(0, symbol.find('('));
  const std::size_t member = before.rfind("::");
  std::string of_class = before.substr(0, member == before.npos ? 0 : member);
  for (const std::string_view prefix : {"vtable for ", "typeinfo for "})
    if (before.starts_with(prefix)) of_class = before.substr(prefix.size());
  return fmt::format("{}{} is in a source that was not named: name all that the controller consists of",
                     Printable(symbol), of_class.empty() ? "" : " of the class " + Printable(of_class));
}

bool TellsOfAnError(const std::string& line) {
  for (const char* sign : {"rror:", "undefined", "ld: "})
    if (line.find(sign) != std::string::npos) return true;
  return false;
}

}  // namespace

std::string BuildErrors(const std::string& output) {
  // As g++ and clang say it.
  static const std::regex missing(
      R"(fatal error: (?:'([^']+)' file not found|([^:]+): No such file or directory).*)");
  // A macro, by its letters.
  static const std::regex undeclared(
      R"re(error: (?:use of undeclared identifier '|‘|')([A-Z][A-Z0-9_]+)(?:’|')(?: was not declared.*)?$)re");
  static const std::regex undefined(R"(undefined (?:reference to|symbol:?) (?:`|'|‘)?([^'’]+))");
  std::vector<std::string> lines;
  std::set<std::string> said;
  std::vector<std::string> advice;
  for (const std::string& line : Split(output, '\n')) {
    if (!TellsOfAnError(line) || !said.insert(line).second) continue;
    lines.push_back(line);
    std::smatch found;
    std::string one;
    if (std::regex_search(line, found, missing)) one = AdviceOn(found[1].matched ? found[1] : found[2]);
    if (std::regex_search(line, found, undeclared)) {
      one = fmt::format("{0} may be a macro that the sources' own build defines: say -D {0}=VALUE",
                        found[1].str());
    }
    if (std::regex_search(line, found, undefined)) one = AdviceOnUndefined(found[1]);
    if (line.find("cannot find -lgauntlet_") != std::string::npos)
      one = "Gauntlet's SDK is not built: give './dev build' in the folder of Gauntlet's sources";
    if (!one.empty() && said.insert(one).second) advice.push_back(one);
  }
  if (lines.empty()) return output;
  lines.resize(std::min(lines.size(), kShownErrors));
  std::string text;
  for (const std::string& line : lines) text += fmt::format("  {}\n", Printable(line));
  for (const std::string& one : advice) text += one + "\n";
  return text;
}

}  // namespace gauntlet
