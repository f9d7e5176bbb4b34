#include "cli/compiler.h"

#include <cstdlib>

#include <fmt/format.h>

#include "base/parse_number.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/split.h"
#include "base/system/process_call.h"
#include "cli/build_errors.h"

namespace gauntlet {
namespace {

// Its name, and what CXX says behind it.
std::vector<std::string> Compiler() {
  const char* const named = std::getenv("CXX");
  std::vector<std::string> words = Split(named == nullptr ? "" : named, ' ');
  std::erase(words, "");
  if (words.empty()) words.emplace_back("c++");
  return words;
}

// Of GCC, whose C++20 is too old before release 10; "" when it is not.
std::string TooOld() {
  std::vector<std::string> call = Compiler();
  call.emplace_back("-dumpversion");
  const Result<CallOutput> told = CallProcess(call, "", {});
  if (!told || told->exit_code != 0) return "";
  const std::string release(told->out.substr(0, told->out.find_last_not_of('\n') + 1));
  const auto major = ParseNumber<int>(release.substr(0, release.find('.')));
  if (!major || *major >= 10) return "";
  return fmt::format(
      ". {} is release {}, and g++ 10 or later is needed: name one by CXX (clusters often have one "
      "to load as a module), or build in Gauntlet's image (docs/bring-your-own-controller.md)",
      Printable(call.front()), Printable(release));
}

}  // namespace

Status RunCompiler(std::vector<std::string> arguments, const std::string& what, std::ostream& said) {
  // Without any, as in some batch jobs, the compiler does not find its own parts.
  setenv("PATH", "/usr/local/bin:/usr/bin:/bin", /*overwrite=*/0);
  const std::vector<std::string> compiler = Compiler();
  arguments.insert(arguments.begin(), compiler.begin(), compiler.end());
  const Result<CallOutput> done = CallProcess(arguments, "", {});
  if (!done && done.error().kind == ErrorKind::kNotFound)
    return InvalidInput(
        fmt::format("there is no compiler {}, which {} is compiled with: install g++ (10 or "
                    "later), or name another one by CXX",
                    Printable(arguments.front()), what));
  if (!done) return done.error();
  if (done->exit_code == 0) return Ok{};
  said << BuildErrors(done->out + done->err) << std::flush;
  return InvalidInput(what + " does not compile: see above" + TooOld());
}

std::string CompilerCall(const std::vector<std::string>& arguments) {
  std::string call;
  for (const std::vector<std::string>& words : {Compiler(), arguments}) {
    for (const std::string& word : words) call += (call.empty() ? "" : " ") + ShellQuoted(word);
  }
  return call;
}

}  // namespace gauntlet
