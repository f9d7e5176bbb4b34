// Every source has a test of its own name (a/b.cc: tests/.../b_test.cc), or a test says at its head that it
// covers it, in comments above its first line of code: "// Covers: a/b.cc, a/c.cc".
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "tests/support/paths.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = GAUNTLET_SOURCE_DIR;

// Below a folder of the repository, relative to it.
std::set<std::string> SourcesIn(const std::string& folder) {
  std::set<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    if (entry.path().extension() == ".cc") found.insert(fs::relative(entry.path(), kRoot).string());
  }
  return found;
}

std::set<std::string> ProductSources() {
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.starts_with(".") || name == "build" || name == "tests") continue;
    found.merge(SourcesIn(name));
  }
  return found;
}

// What a test says at its head that it covers.
std::set<std::string> ClaimsOf(const std::string& test) {
  static const std::regex kSource(R"([\w/]+\.cc)");
  std::ifstream in(kRoot / test);
  std::set<std::string> claims;
  bool claiming = false;
  for (std::string line; std::getline(in, line) && line.starts_with("//");) {
    claiming = claiming || line.starts_with("// Covers: ");
    if (!claiming) continue;
    for (std::sregex_iterator at(line.begin(), line.end(), kSource), end; at != end; ++at)
      claims.insert(at->str());
  }
  return claims;
}

TEST(CoveredSources, EachHasATestOfItsNameOrOneThatSaysSo) {
  const std::set<std::string> sources = ProductSources();
  ASSERT_GT(sources.size(), 300U);
  std::set<std::string> names;
  std::set<std::string> claimed;
  for (const std::string& test : SourcesIn("tests")) {
    names.insert(fs::path(test).stem());
    for (const std::string& source : ClaimsOf(test)) {
      EXPECT_TRUE(sources.contains(source)) << test << " says that it covers " << source << ", which is gone";
      claimed.insert(source);
    }
  }
  for (const std::string& source : sources) {
    const std::string own = fs::path(source).stem().string() + "_test";
    EXPECT_TRUE(names.contains(own) || claimed.contains(source))
        << source << " has no test: write " << own << ".cc, or say '// Covers: " << source
        << "' at the head of the test that holds it";
  }
}

}  // namespace
}  // namespace gauntlet
