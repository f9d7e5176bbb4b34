// What `export` and `show --runs` refuse, and what the help of `export` promises; the rest is held against
// real campaigns in tests/integration/export_test.cc.
#include "cli/output/output_file.h"
#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

TEST_F(CommandLine, AnOutputDirectoryIsThereAsAWholeOrNotAtAll) {
  const auto write = [&](const std::string& path, bool fails) {
    return WriteOutputDirectory("--out", path, [&](const std::string& draft) -> Result<std::uint64_t> {
      std::ofstream(draft + "/one") << "x";
      EXPECT_FALSE(std::filesystem::exists(path + "/one"));
      if (fails) return Error{ErrorKind::kNoSpace, "full"};
      return std::uint64_t{1};
    });
  };
  EXPECT_EQ(write(Path("failed"), true).error().kind, ErrorKind::kNoSpace);
  EXPECT_TRUE(std::filesystem::is_empty(directory_));
  EXPECT_EQ(write(Path("new/"), false).value(), 1U);
  EXPECT_EQ(Read(Path("new/one")), "x");
  const Result<std::uint64_t> again = write(Path("new"), false);
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().message,
            "--out " + Path("new") + ": there is something already; give a directory that is new or empty");
  std::filesystem::create_directory(Path("empty"));
  EXPECT_TRUE(write(Path("empty"), false).ok());
  EXPECT_THAT(Read(Path("empty/one")), "x");
}

}  // namespace
}  // namespace gauntlet
