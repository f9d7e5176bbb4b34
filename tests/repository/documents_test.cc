// Holds what people read against its own rules: short where it is the front, linked, and without dead ends.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/paths.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::Contains;

const fs::path kSourceRoot = GAUNTLET_SOURCE_DIR;

struct DocumentLine {
  std::string text;
  bool code = false;  // of a fenced or an indented block
};

std::vector<DocumentLine> ReadDocument(const std::string& document) {
  std::ifstream in(kSourceRoot / document);
  std::vector<DocumentLine> lines;
  bool fenced = false;
  for (std::string text; std::getline(in, text);) {
    const bool fence = text.starts_with("```");
    if (fence) fenced = !fenced;
    lines.push_back({text, fenced || fence || text.starts_with("    ")});
  }
  return lines;
}

// Every Markdown page of ours, relative to the repository.
std::vector<std::string> Documents() {
  std::vector<std::string> found;
  for (auto entry = fs::recursive_directory_iterator(kSourceRoot); entry != fs::end(entry); ++entry) {
    const std::string path = fs::relative(entry->path(), kSourceRoot).string();
    if (entry->is_directory() && (path == "build" || path.starts_with("."))) {
      entry.disable_recursion_pending();
    } else if (path.ends_with(".md")) {
      found.push_back(path);
    }
  }
  return found;
}

// Written by `gauntlet study` and `gauntlet tune`.
bool IsGenerated(const std::string& document) {
  return document == "docs/thesis-figures.md" || document == "docs/tuning-flocking.md" ||
         document == "docs/beyond-thesis.md";
}

std::set<std::string> LinksOf(const std::string& document) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  std::set<std::string> links;
  for (const DocumentLine& line : ReadDocument(document)) {
    if (line.code) continue;
    const std::sregex_iterator end;
    for (std::sregex_iterator i(line.text.begin(), line.text.end(), link); i != end; ++i)
      links.insert((*i)[1]);
  }
  return links;
}

// What a link to one of its headings ends with, as GitHub makes it.
std::set<std::string> AnchorsOf(const std::string& document) {
  std::set<std::string> anchors;
  for (const DocumentLine& line : ReadDocument(document)) {
    if (line.code || !line.text.starts_with("#")) continue;
    std::string anchor;
    for (const char c : line.text.substr(std::min(line.text.find(' ') + 1, line.text.size()))) {
      const auto byte = static_cast<unsigned char>(c);
      if (std::isalnum(byte) != 0 || c == '-' || c == '_') anchor += static_cast<char>(std::tolower(byte));
      if (c == ' ') anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

std::size_t Characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

TEST(Documents, FrontPageIsShort) {
  EXPECT_LE(ReadDocument("README.md").size(), 110U);
}

TEST(Documents, FrontPageBeginsWithAPictureOfWhatIsFound) {
  const std::vector<DocumentLine> lines = ReadDocument("README.md");
  const auto starts = [](std::string_view with) {
    return [with](const DocumentLine& line) { return line.text.starts_with(with); };
  };
  EXPECT_LT(std::ranges::find_if(lines, starts("![")), std::ranges::find_if(lines, starts("## ")));
}

TEST(Documents, ChangelogIsShort) {
  const std::vector<DocumentLine> lines = ReadDocument("CHANGELOG.md");
  EXPECT_LE(std::ranges::count_if(lines, [](const DocumentLine& line) { return !line.text.empty(); }), 30);
}

TEST(Documents, IndexLinksEveryPage) {
  const std::set<std::string> links = LinksOf("docs/README.md");
  for (const std::string& document : Documents()) {
    const fs::path path = document;
    if (path.parent_path() == "docs" && document != "docs/README.md") {
      EXPECT_THAT(links, Contains(path.filename().string()));
    }
  }
}

TEST(Documents, EveryLinkLeadsSomewhere) {
  for (const std::string& document : Documents()) {
    for (const std::string& link : LinksOf(document)) {
      if (link.starts_with("http")) continue;
      const std::string path = link.substr(0, link.find('#'));
      const fs::path target =
          path.empty() ? fs::path(document) : (fs::path(document).parent_path() / path).lexically_normal();
      ASSERT_TRUE(fs::exists(kSourceRoot / target)) << document << " links " << link;
      if (link.find('#') == std::string::npos) continue;
      EXPECT_THAT(AnchorsOf(target.string()), Contains(link.substr(link.find('#') + 1)))
          << document << " links " << link;
    }
  }
}

// `sim/simulation.cc` between backquotes, say.
TEST(Documents, EverySourceThatTheyNameExists) {
  static const std::regex source(R"(`([a-z]+(/[A-Za-z0-9_.-]+)+\.(h|cc|md|toml|txt|proto|sbatch|argos)))");
  for (const std::string& document : Documents()) {
    for (const DocumentLine& line : ReadDocument(document)) {
      const std::sregex_iterator end;
      for (std::sregex_iterator i(line.text.begin(), line.text.end(), source); i != end; ++i) {
        const std::string name = (*i)[1];
        if (line.code || !fs::is_directory(kSourceRoot / name.substr(0, name.find('/')))) continue;
        const bool made_up =
            fs::path(name).filename().string().starts_with("my_") || name.starts_with("tests/a/");
        EXPECT_TRUE(made_up || fs::exists(kSourceRoot / name) ||
                    fs::exists((kSourceRoot / document).parent_path() / name))
            << document << " names " << name;
      }
    }
  }
}

TEST(Documents, ProseIsNotWide) {
  for (const std::string& document : Documents()) {
    if (IsGenerated(document)) continue;
    int number = 0;
    for (const DocumentLine& line : ReadDocument(document)) {
      ++number;
      if (line.code || line.text.starts_with("|") || line.text.starts_with("![")) continue;
      EXPECT_LE(Characters(line.text), 120U) << fmt::format("{}:{}", document, number);
    }
  }
}

}  // namespace
}  // namespace gauntlet
