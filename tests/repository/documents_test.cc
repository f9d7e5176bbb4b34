// What holds of the documents that people read: they are short where that was promised, and lead on to each
// other.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = GAUNTLET_SOURCE_DIR;

std::string TextOf(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> Documents() {
  std::vector<fs::path> found;
  for (auto entry = fs::recursive_directory_iterator(kRoot); entry != fs::end(entry); ++entry) {
    const std::string name = entry->path().filename();
    if (entry->is_directory() && (name == "build" || name.starts_with(".")))
      entry.disable_recursion_pending();
    if (entry->path().extension() == ".md") found.push_back(entry->path());
  }
  return found;
}

TEST(Documents, TheFrontPageIsShort) {
  const std::string readme = TextOf(kRoot / "README.md");
  EXPECT_LE(std::ranges::count(readme, '\n'), 110);
  EXPECT_LT(readme.find("](docs/first-result.svg)"), readme.find("\n## "))
      << "the picture stands above the first heading";
}

TEST(Documents, TheFirstReleaseIsToldInThirtyLines) {
  const std::string changelog = TextOf(kRoot / "CHANGELOG.md");
  EXPECT_LE(std::ranges::count(changelog, '\n'), 30);
}

TEST(Documents, TheIndexNamesEveryPage) {
  const std::string index = TextOf(kRoot / "docs/README.md");
  for (const auto& page : fs::directory_iterator(kRoot / "docs")) {
    const std::string name = page.path().filename();
    if (page.path().extension() != ".md" || name == "README.md") continue;
    EXPECT_NE(index.find("(" + name + ")"), std::string::npos) << name;
  }
}

TEST(Documents, LinksLeadToFiles) {
  const std::regex link(R"(\]\(([^)#\s]+)(#[^)]*)?\))");
  for (const fs::path& document : Documents()) {
    const std::string text = TextOf(document);
    for (std::sregex_iterator it(text.begin(), text.end(), link); it != std::sregex_iterator(); ++it) {
      const std::string target = (*it)[1];
      if (target.find(':') != std::string::npos) continue;  // an address
      EXPECT_TRUE(fs::exists(document.parent_path() / target)) << document << " links to " << target;
    }
  }
}

}  // namespace
}  // namespace gauntlet
