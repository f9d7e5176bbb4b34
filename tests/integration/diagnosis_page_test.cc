// Every command of docs/diagnose.md, run in its order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"

namespace gauntlet::testing_support {
namespace {

using testing::Contains;
using testing::StartsWith;

TEST(DiagnosisPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const TemporaryDirectory scratch;
  const DocumentedPage page = ReadPage("diagnose.md");
  for (const char* command :
       {"evolve", "confirm", "show", "replay", "minimise", "blame", "corpus add", "check"})
    EXPECT_THAT(page.commands, Contains(StartsWith(std::string("gauntlet ") + command)));
  std::string said;
  for (const std::string& command : page.commands) {
    SCOPED_TRACE(command);
    std::vector<std::string> arguments = Words(command);
    arguments.erase(arguments.begin());
    for (std::string& argument : arguments) {
      // What the page keeps in the reader's folder is kept in the scratch directory.
      const bool of_reader = argument.starts_with("campaigns/") || argument.ends_with(".svg") ||
                             argument.ends_with(".xml") || argument == "corpus";
      if (of_reader && &argument != &arguments.front()) argument = scratch / argument;
    }
    const ProcessResult result = Gauntlet(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    said += AsRead(result.out, scratch.path());
  }
  EXPECT_GE(page.quoted.size(), 8U);
  ExpectQuoted(page, said);
  EXPECT_TRUE(std::filesystem::exists(scratch / "corpus/run-8.json"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "check.xml"));
}

}  // namespace
}  // namespace gauntlet::testing_support
