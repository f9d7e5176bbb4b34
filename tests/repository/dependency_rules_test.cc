// Reads every #include and holds it against the dependency rules of ARCHITECTURE.md.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/paths.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the repository
  std::string target;  // as written between the quotes or brackets
  int line = 0;
};

const std::vector<std::string>& Layers() {
  static const std::vector<std::string> layers = {"analysis", "controllers", "master", "proto",
                                                  "sim",      "slurm",       "worker"};
  return layers;
}

bool StartsWith(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

bool StartsWithAny(std::string_view text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes) {
    if (StartsWith(text, prefix)) return true;
  }
  return false;
}

// The include of a source line, or "".
std::string IncludedBy(std::string_view line) {
  if (!StartsWith(line, "#include ")) return {};
  const std::size_t begin = line.find_first_of("\"<", 8);
  const std::size_t end = line.find_last_of("\">");
  if (begin == std::string_view::npos || end <= begin) return {};
  return std::string(line.substr(begin + 1, end - begin - 1));
}

std::vector<Include> IncludesOf(const std::string& layer) {
  std::vector<Include> includes;
  const fs::path root = GAUNTLET_SOURCE_DIR;
  if (!fs::exists(root / layer)) return includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / layer)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".h" && path.extension() != ".cc") continue;
    std::ifstream in(path);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      std::string target = IncludedBy(line);
      if (!target.empty()) includes.push_back({fs::relative(path, root).string(), std::move(target), number});
    }
  }
  return includes;
}

bool IsOurs(std::string_view target) {
  for (const std::string& layer : Layers()) {
    if (StartsWith(target, layer + "/")) return true;
  }
  return false;
}

struct LayerRule {
  std::string layer;
  std::vector<std::string> ours;         // prefixes of our own headers it may include
  std::vector<std::string> third_party;  // prefixes of libraries it must not include
};

void PrintTo(const LayerRule& rule, std::ostream* os) {
  *os << rule.layer;
}

class LayerTest : public testing::TestWithParam<LayerRule> {};

TEST_P(LayerTest, IncludesOnlyWhatItMayKnow) {
  const LayerRule& rule = GetParam();
  for (const Include& include : IncludesOf(rule.layer)) {
    if (IsOurs(include.target)) {
      EXPECT_TRUE(StartsWithAny(include.target, rule.ours))
          << fmt::format("{}:{} includes {}, which {} must not know", include.file, include.line,
                         include.target, rule.layer);
    } else {
      EXPECT_FALSE(StartsWithAny(include.target, rule.third_party))
          << fmt::format("{}:{} includes <{}>, which {} must not use", include.file, include.line,
                         include.target, rule.layer);
    }
  }
}

const std::vector<std::string> kWorldOutside = {
    "zmq",    "google/", "spdlog/", "sqlite3",    "toml++", "nlohmann/", "pugixml",  "CLI/",
    "thread", "mutex",   "fstream", "filesystem", "chrono", "sys/",      "unistd.h", "fcntl.h"};

INSTANTIATE_TEST_SUITE_P(
    DependencyRules, LayerTest,
    testing::Values(
        LayerRule{"sim", {"sim/"}, kWorldOutside},
        LayerRule{"controllers",
                  {"controllers/", "base/", "sim/geometry/", "sim/random/", "sim/arena/", "sim/robot/",
                   "sim/scenario.h", "sim/observer.h", "sim/headquarters.h", "sim/run_spec.h",
                   "sim/run_result.h", "sim/run_style.h"},
                  [] {
                    std::vector<std::string> libraries = kWorldOutside;
                    libraries.push_back("box2d");
                    return libraries;
                  }()},
        LayerRule{"worker", {"worker/", "sim/", "controllers/registry.h", "proto/"}, {"box2d", "sqlite3"}},
        LayerRule{"analysis",
                  {"analysis/", "base/", "sim/geometry/", "sim/arena/", "sim/random/", "sim/run_spec.h",
                   "sim/run_result.h", "sim/run_style.h", "sim/observer.h", "sim/robot/foot_bot.h"},
                  {"zmq", "google/", "sqlite3", "box2d", "thread", "sys/"}},
        LayerRule{"master",
                  {"master/", "analysis/", "slurm/", "proto/", "base/", "sim/geometry/", "sim/arena/",
                   "sim/random/", "sim/run_spec.h", "sim/run_result.h", "sim/run_style.h", "sim/observer.h",
                   "sim/robot/foot_bot.h", "sim/robot/disturbances.h", "sim/robot/color.h",
                   "controllers/registry.h"},
                  {"box2d"}},
        LayerRule{"slurm", {"slurm/", "base/"}, {"zmq", "google/", "sqlite3", "box2d"}}),
    [](const testing::TestParamInfo<LayerRule>& parameter) { return parameter.param.layer; });

// The rooms of sim stand one upon the other: geometry, random, arena, robot; then physics and sensors, which
// do not know each other. The files beside them tie them together.
INSTANTIATE_TEST_SUITE_P(
    RoomsOfSim, LayerTest,
    testing::Values(LayerRule{"sim/geometry", {"sim/geometry/"}, {}},
                    LayerRule{"sim/random", {"sim/geometry/", "sim/random/"}, {}},
                    LayerRule{"sim/arena", {"sim/geometry/", "sim/random/", "sim/arena/"}, {}},
                    LayerRule{"sim/robot", {"sim/geometry/", "sim/random/", "sim/arena/", "sim/robot/"}, {}},
                    LayerRule{"sim/physics", {"sim/geometry/", "sim/robot/foot_bot.h", "sim/physics/"}, {}},
                    LayerRule{
                        "sim/sensors", {"sim/geometry/", "sim/arena/", "sim/robot/", "sim/sensors/"}, {}}),
    [](const testing::TestParamInfo<LayerRule>& parameter) {
      return parameter.param.layer.substr(parameter.param.layer.find('/') + 1);
    });

// Libraries that stay behind one door.
struct Door {
  std::string name;
  std::string library;
  std::vector<std::string> allowed;  // prefixes of files
};

void PrintTo(const Door& door, std::ostream* os) {
  *os << door.name;
}

class DoorTest : public testing::TestWithParam<Door> {};

TEST_P(DoorTest, LibraryStaysBehindItsDoor) {
  const Door& door = GetParam();
  int uses = 0;
  for (const std::string& layer : Layers()) {
    for (const Include& include : IncludesOf(layer)) {
      if (!StartsWith(include.target, door.library)) continue;
      ++uses;
      EXPECT_TRUE(StartsWithAny(include.file, door.allowed))
          << fmt::format("{}:{} includes {}", include.file, include.line, include.target);
    }
  }
  EXPECT_GT(uses, 0) << "nobody includes " << door.library << ": is this rule still needed?";
}

INSTANTIATE_TEST_SUITE_P(DependencyRules, DoorTest,
                         testing::Values(Door{"Box2d", "box2d", {"sim/physics/box2d_engine.cc"}},
                                         Door{"Random123", "Random123", {"sim/random/"}},
                                         Door{"Sqlite", "sqlite3", {"master/store/"}},
                                         Door{"TomlPlusPlus", "toml++", {"master/experiment/"}},
                                         Door{"PugiXml", "pugixml", {"master/cases/"}},
                                         Door{"Cli11", "CLI/", {"master/cli/", "worker/command_line.cc"}},
                                         Door{"Protobuf", "google/protobuf", {"worker/", "master/dispatch/"}},
                                         Door{"ProtobufTypes", "proto/", {"worker/", "master/dispatch/"}},
                                         Door{"ZeroMq", "zmq", {"worker/", "master/dispatch/"}}),
                         [](const testing::TestParamInfo<Door>& parameter) { return parameter.param.name; });

TEST(DependencyRules, HeavyLibrariesStayOutOfHeaders) {
  for (const std::string& layer : Layers()) {
    for (const Include& include : IncludesOf(layer)) {
      if (!include.file.ends_with(".h")) continue;
      EXPECT_FALSE(
          StartsWithAny(include.target, {"nlohmann/json.hpp", "CLI/", "toml++", "spdlog/", "google/"}))
          << fmt::format("{}:{} includes {}", include.file, include.line, include.target);
    }
  }
}

// A file's size is a question, not a crime; past these figures the answer has been "two concepts".
TEST(DependencyRules, FilesHoldOneConcept) {
  for (const std::string& layer : Layers()) {
    const fs::path root = fs::path(GAUNTLET_SOURCE_DIR) / layer;
    if (!fs::exists(root)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cc") continue;
      std::ifstream in(entry.path());
      const auto lines =
          std::count(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>(), '\n');
      EXPECT_LE(lines, extension == ".h" ? 300 : 600) << entry.path();
    }
  }
}

}  // namespace
}  // namespace gauntlet
