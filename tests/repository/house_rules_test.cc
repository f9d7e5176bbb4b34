// Reads every #include and holds it against the house rules of ARCHITECTURE.md.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/paths.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using Prefixes = std::vector<std::string>;

// A folder with a purpose of its own.
struct Room {
  std::string path;       // a file belongs to the room whose path is the longest that fits
  Prefixes rooms;         // that it may include, beside itself
  Prefixes headers;       // of other rooms, that it may include too
  Prefixes no_libraries;  // prefixes of what it must not include
  bool operator==(const Room& other) const { return path == other.path; }
};

void PrintTo(const Room& room, std::ostream* os) {
  *os << room.path;
}

const Prefixes kTheOutsideWorld = {"zmq",     "google/", "spdlog/",  "sqlite3", "toml++",  "nlohmann/",
                                   "pugixml", "CLI/",    "thread",   "mutex",   "fstream", "filesystem",
                                   "chrono",  "sys/",    "unistd.h", "fcntl.h", "box2d"};

Prefixes Without(const Prefixes& some, Prefixes all) {
  std::erase_if(all, [&](const std::string& one) { return std::ranges::count(some, one) > 0; });
  return all;
}

Prefixes operator+(Prefixes a, const Prefixes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// What a run is made of and what came of it, without the machinery that simulates it.
const Prefixes kRunData = {"sim/geometry/", "sim/arena/", "sim/random/", "sim/run_spec.h",
                           "sim/run_result.h"};
const Prefixes kSwarmData = {"sim/observer.h", "sim/run_style.h", "sim/robot/foot_bot.h",
                             "sim/robot/disturbances.h"};
const Prefixes kBehaviours = {
    "controllers/registry.h",  "controllers/behaviour.h", "controllers/failure_descriptor.h",
    "controllers/run_start.h", "controllers/rows/",       "controllers/requirements/"};

// The house from the ground up: a room includes rooms that stand before it here, never one that comes later.
const std::vector<Room>& House() {
  static const std::vector<Room> house = {
      {"base", {}, {}, kTheOutsideWorld},
      {"base/system", {"base"}, {}, {"zmq", "google/", "sqlite3", "box2d", "nlohmann/"}},
      {"sim/geometry", {}, {}, kTheOutsideWorld},
      {"sim/random", {"base", "sim/geometry"}, {}, kTheOutsideWorld},
      {"sim/arena", {"base", "sim/geometry", "sim/random"}, {}, kTheOutsideWorld},
      {"sim/robot", {"base", "sim/geometry", "sim/random", "sim/arena"}, {}, kTheOutsideWorld},
      {"sim/physics",
       {"base", "sim/geometry"},
       {"sim/robot/foot_bot.h"},
       Without({"box2d"}, kTheOutsideWorld)},
      {"sim/sensors", {"base", "sim/geometry", "sim/arena", "sim/robot"}, {}, kTheOutsideWorld},
      {"sim",
       {"base", "sim/geometry", "sim/arena", "sim/robot", "sim/physics", "sim/sensors"},
       {},
       kTheOutsideWorld},
      {"controllers",
       {"base"},
       kRunData + Prefixes{"sim/robot/", "sim/scenario.h", "sim/observer.h", "sim/run_style.h",
                           "sim/run_start.h", "sim/contacts.h"},
       Without({"mutex"}, kTheOutsideWorld)},
      {"controllers/rows", {"base", "controllers"}, {}, Without({"nlohmann/"}, kTheOutsideWorld)},
      {"controllers/command",
       {"base", "controllers", "controllers/rows"},
       kRunData + Prefixes{"sim/observer.h"},
       Without({"nlohmann/", "fstream", "filesystem"}, kTheOutsideWorld)},
      {"sdk",
       {"base"},
       {"controllers/behaviour.h", "controllers/rows/plugin_rows.h", "sim/robot/controller.h",
        "sim/scenario.h"},
       kTheOutsideWorld},
      {"argos",
       {"base", "sdk"},
       {"controllers/behaviour.h", "sim/arena/color.h", "sim/geometry/directions.h",
        "sim/geometry/trigonometry.h", "sim/robot/controller.h"},
       Without({"fstream"}, kTheOutsideWorld)},
      {"sdk/example", {"controllers", "sdk"}, {"sim/arena/"}, kTheOutsideWorld},
      {"proto",
       {"base", "base/system"},
       kRunData + kSwarmData + Prefixes{"sim/run_start.h"},
       {"zmq", "sqlite3", "box2d"}},
      {"worker",
       {"base", "base/system", "sim", "sim/geometry", "sim/random", "sdk", "proto"},
       kBehaviours + Prefixes{"controllers/command/"},
       {"box2d", "sqlite3", "toml++", "pugixml"}},
      {"analysis", {"base"}, kRunData + kSwarmData, {"zmq", "google/", "sqlite3", "box2d", "thread", "sys/"}},
      {"search/experiment",
       {"base", "base/system"},
       kRunData + kSwarmData + kBehaviours +
           Prefixes{"controllers/generic/definition.h", "controllers/command/definition.h",
                    "controllers/command/requirements.h"},
       {"box2d", "zmq"}},
      {"search/cases",
       {"base", "base/system", "proto"},
       kRunData + kSwarmData + Prefixes{"sim/run_start.h"},
       {"box2d", "zmq"}},
      {"search",
       {"base", "analysis", "search/experiment"},
       kRunData + kSwarmData + kBehaviours +
           Prefixes{"controllers/generic/formula.h", "controllers/command/definition.h"},
       kTheOutsideWorld},
      {"master/http",
       {"base", "base/system"},
       {},
       {"box2d", "zmq", "google/", "sqlite3", "nlohmann/", "spdlog/"}},
      {"master/store",
       {"base", "base/system", "proto", "search"},
       kRunData,
       {"box2d", "zmq", "google/", "nlohmann/", "spdlog/"}},
      {"master/dispatch/trust", {"base", "base/system", "proto"}, {}, kTheOutsideWorld},
      {"master/dispatch",
       {"base", "base/system", "proto", "master/dispatch/trust"},
       kRunData + kSwarmData + kBehaviours +
           Prefixes{"controllers/command/definition.h", "master/store/event_kinds.h"},
       {"box2d", "sqlite3", "nlohmann/"}},
      {"master/directory",
       {"base", "base/system", "proto", "search/experiment", "search", "master/store", "master/dispatch"},
       {"controllers/registry.h", "controllers/rows/", "controllers/command/"},
       {"box2d", "zmq", "sqlite3"}},
      {"master/campaign",
       {"base", "proto", "search/experiment", "search", "master/store", "master/dispatch",
        "master/dispatch/trust", "master/directory"},
       kRunData + kSwarmData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"master/session",
       {"base", "base/system", "proto", "search/experiment", "search", "master/http", "master/store",
        "master/dispatch", "master/directory", "master/campaign"},
       kRunData + kSwarmData + kBehaviours + Prefixes{"controllers/command/definition.h"},
       {"box2d", "zmq", "sqlite3"}},
      {"slurm",
       {"base", "base/system", "search/experiment"},
       {"master/dispatch/pool/worker_pool.h"},
       {"zmq", "google/", "sqlite3", "box2d"}},
      {"study/sets",
       {"base", "base/system", "proto", "analysis", "search/experiment", "search", "master/directory",
        "master/campaign"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"study/questions",
       {"base", "base/system", "proto", "analysis", "search/experiment", "search/cases", "search",
        "master/store", "master/dispatch", "master/directory", "master/campaign", "study/sets"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"study/streams",
       {"base", "proto", "search/experiment", "search/cases", "search", "master/store", "master/campaign",
        "study/questions"},
       kRunData + kBehaviours +
           Prefixes{"master/session/evaluation_feed.h", "master/dispatch/leases/run_limits.h"},
       {"box2d", "zmq", "sqlite3"}},
      {"study/fits",
       {"base", "base/system", "proto", "analysis", "search/experiment", "search/cases", "search",
        "master/campaign", "study/sets", "study/questions"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"study/margins",
       {"base", "proto", "analysis", "search", "master/campaign"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"study/probabilities",
       {"base", "proto", "analysis", "search/experiment", "search", "master/store", "master/campaign",
        "study/sets"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"study/repairs",
       {"base", "base/system", "proto", "analysis", "search/experiment", "search/cases", "search",
        "master/campaign", "master/directory", "study/questions"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"study",
       {"base", "base/system", "proto", "analysis", "search/experiment", "search", "master/store",
        "master/directory", "master/campaign", "study/sets"},
       kRunData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"report/tables",
       {"base", "proto", "analysis", "search/experiment", "search", "master/store", "master/dispatch",
        "master/directory", "master/campaign", "study/sets", "study/questions"},
       kRunData + kSwarmData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"report/figures",
       {"base", "proto", "analysis", "search", "master/store", "master/directory", "master/campaign",
        "study/sets", "study/questions", "study/fits", "study/margins", "study/probabilities",
        "study/repairs", "study", "report/tables"},
       kRunData + kSwarmData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"report/pages",
       {"base", "proto", "analysis", "search", "master/campaign", "study/sets", "study", "report/tables",
        "report/figures"},
       kRunData + kSwarmData + kBehaviours,
       {"box2d", "zmq", "sqlite3"}},
      {"report/ui",
       {"base", "master/http", "master/store", "master/directory", "master/session", "report/figures",
        "report/pages"},
       {},
       {"box2d", "zmq", "sqlite3"}},
      {"cli",
       {"base",
        "base/system",
        "proto",
        "analysis",
        "search/experiment",
        "search/cases",
        "search",
        "master/http",
        "master/directory",
        "master/campaign",
        "master/session",
        "slurm",
        "study/sets",
        "study/questions",
        "study/fits",
        "study/margins",
        "study/probabilities",
        "study/repairs",
        "study/streams",
        "study",
        "report/tables",
        "report/figures",
        "report/pages",
        "report/ui"},
       kRunData + kSwarmData + kBehaviours + Prefixes{"controllers/command/"},
       {"box2d", "zmq", "sqlite3"}},
      {"release", {}, {}, {"box2d", "zmq", "google/", "sqlite3", "nlohmann/", "thread", "filesystem"}},
  };
  return house;
}

bool StartsWithAny(std::string_view text, const Prefixes& prefixes) {
  return std::ranges::any_of(prefixes,
                             [text](const std::string& prefix) { return text.starts_with(prefix); });
}

// Where a file stands in House(); its size when nowhere.
std::size_t RoomOf(std::string_view file) {
  std::size_t best = House().size();
  for (std::size_t i = 0; i < House().size(); ++i) {
    const std::string& path = House()[i].path;
    if (!file.starts_with(path + "/")) continue;
    if (best == House().size() || path.size() > House()[best].path.size()) best = i;
  }
  return best;
}

struct Include {
  std::string file;    // relative to the repository
  std::string target;  // as written between the quotes or brackets
  bool quoted = false;
  int line = 0;
};

// Every source of ours without the tests, relative to the repository.
const std::vector<std::string>& Sources() {
  static const std::vector<std::string> sources = [] {
    std::vector<std::string> found;
    const fs::path root = GAUNTLET_SOURCE_DIR;
    for (auto entry = fs::recursive_directory_iterator(root); entry != fs::end(entry); ++entry) {
      const std::string path = fs::relative(entry->path(), root).string();
      // Tests, and what is not ours or not source: builds, git's own files.
      if (path == "tests" || path == "build" || path.starts_with(".")) {
        if (entry->is_directory()) entry.disable_recursion_pending();
      } else if (path.ends_with(".h") || path.ends_with(".cc")) {
        found.push_back(path);
      }
    }
    return found;
  }();
  return sources;
}

std::string TopOf(const std::string& file) {
  return file.substr(0, file.find('/'));
}

std::vector<std::string> LinesOf(const std::string& file) {
  std::ifstream in(fs::path(GAUNTLET_SOURCE_DIR) / file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

const std::vector<Include>& Includes() {
  static const std::vector<Include> includes = [] {
    std::vector<Include> found;
    for (const std::string& file : Sources()) {
      int number = 0;
      for (const std::string& line : LinesOf(file)) {
        ++number;
        if (!line.starts_with("#include ")) continue;
        const std::size_t begin = line.find_first_of("\"<");
        const std::size_t end = line.find_last_of("\">");
        if (begin == std::string::npos || end <= begin) continue;
        found.push_back({file, line.substr(begin + 1, end - begin - 1), line[begin] == '"', number});
      }
    }
    return found;
  }();
  return includes;
}

class RoomTest : public testing::TestWithParam<Room> {};

TEST_P(RoomTest, IncludesOnlyWhatItMayKnow) {
  const Room& room = GetParam();
  for (const Include& include : Includes()) {
    if (RoomOf(include.file) == House().size() || House()[RoomOf(include.file)] != room) continue;
    if (!include.quoted) {
      EXPECT_FALSE(StartsWithAny(include.target, room.no_libraries))
          << fmt::format("{}:{} includes <{}>, which {} must not use", include.file, include.line,
                         include.target, room.path);
      continue;
    }
    const std::size_t target = RoomOf(include.target);
    const bool may_know =
        target < House().size() &&
        (House()[target] == room || std::ranges::count(room.rooms, House()[target].path) > 0 ||
         StartsWithAny(include.target, room.headers));
    EXPECT_TRUE(may_know) << fmt::format("{}:{} includes {}, which {} must not know", include.file,
                                         include.line, include.target, room.path);
  }
}

INSTANTIATE_TEST_SUITE_P(DependencyRules, RoomTest, testing::ValuesIn(House()),
                         [](const testing::TestParamInfo<Room>& parameter) {
                           std::string name = parameter.param.path;
                           std::ranges::replace(name, '/', '_');
                           return name;
                         });

TEST(DependencyRules, PointOneWay) {
  for (std::size_t i = 0; i < House().size(); ++i) {
    const Room& room = House()[i];
    for (const std::string& known : room.rooms + room.headers) {
      const auto before = std::find_if(
          House().begin(), House().begin() + static_cast<std::ptrdiff_t>(i),
          [&](const Room& one) { return known == one.path || known.starts_with(one.path + "/"); });
      EXPECT_NE(before, House().begin() + static_cast<std::ptrdiff_t>(i))
          << room.path << " may include " << known << ", which does not stand before it";
    }
  }
}

// A permission that nobody uses is a door that somebody forgot to close.
TEST(DependencyRules, AreNotWiderThanTheHouse) {
  for (const Room& room : House()) {
    for (const std::string& known : room.rooms) {
      const bool used = std::ranges::any_of(Includes(), [&](const Include& include) {
        return include.quoted && RoomOf(include.file) < House().size() &&
               House()[RoomOf(include.file)] == room && RoomOf(include.target) < House().size() &&
               House()[RoomOf(include.target)].path == known;
      });
      EXPECT_TRUE(used) << room.path << " may include " << known << ", and does not";
    }
  }
}

// Libraries that stay behind one door.
struct Door {
  std::string name;
  std::string library;  // how its includes begin or end
  Prefixes allowed;     // prefixes of files
};

void PrintTo(const Door& door, std::ostream* os) {
  *os << door.name;
}

class DoorTest : public testing::TestWithParam<Door> {};

TEST_P(DoorTest, LibraryStaysBehindItsDoor) {
  const Door& door = GetParam();
  int uses = 0;
  for (const Include& include : Includes()) {
    if (!include.target.starts_with(door.library) && !include.target.ends_with(door.library)) continue;
    ++uses;
    EXPECT_TRUE(StartsWithAny(include.file, door.allowed))
        << fmt::format("{}:{} includes {}", include.file, include.line, include.target);
  }
  EXPECT_GT(uses, 0) << "nobody includes " << door.library << ": is this rule still needed?";
}

INSTANTIATE_TEST_SUITE_P(
    DependencyRules, DoorTest,
    testing::Values(
        Door{"Box2d", "box2d", {"sim/physics/box2d_engine"}}, Door{"Random123", "Random123", {"sim/random/"}},
        Door{"Sqlite", "sqlite3", {"master/store/"}}, Door{"Zstandard", "zstd", {"master/store/"}},
        Door{"TomlPlusPlus", "toml++", {"search/experiment/"}}, Door{"PugiXml", "pugixml", {"search/cases/"}},
        Door{"BoostMath", "boost/math", {"analysis/statistics/distributions.cc"}},
        Door{"BoostBeast", "boost/beast", {"master/http/http_server.cc"}},
        Door{"BoostAsio", "boost/asio", {"master/http/http_server.cc"}},
        Door{"Boost", "boost/", {"analysis/statistics/distributions.cc", "master/http/http_server.cc"}},
        Door{"Cli11", "CLI/", {"cli/", "worker/command_line.cc"}},
        Door{"Protobuf", "google/protobuf", {"proto/"}}, Door{"ProtobufTypes", ".pb.h", {"proto/"}},
        Door{"MuParser", "muParser", {"controllers/generic/formula.cc"}},
        Door{"RE2", "re2/", {"controllers/command/metric_source.cc"}},
        Door{"ZeroMq", "zmq", {"worker/", "master/dispatch/"}}),
    [](const testing::TestParamInfo<Door>& parameter) { return parameter.param.name; });

TEST(DependencyRules, HeavyLibrariesStayOutOfHeaders) {
  for (const Include& include : Includes()) {
    if (!include.file.ends_with(".h")) continue;
    EXPECT_FALSE(StartsWithAny(include.target, {"nlohmann/json.hpp", "CLI/", "toml++", "spdlog/", "google/"}))
        << fmt::format("{}:{} includes {}", include.file, include.line, include.target);
  }
}

// A folder that the rules above or clang-tidy do not see would grow wild.
TEST(House, EveryFolderIsUnderItsRules) {
  std::ifstream settings(fs::path(GAUNTLET_SOURCE_DIR) / ".clang-tidy");
  std::string headers;  // of which clang-tidy tells
  const std::string key = "HeaderFilterRegex: ";
  for (std::string line; std::getline(settings, line);) {
    if (line.starts_with(key)) headers = line.substr(key.size() + 1, line.size() - key.size() - 2);
  }
  ASSERT_NE(headers, "");
  for (const std::string& file : Sources()) {
    EXPECT_LT(RoomOf(file), House().size()) << file << " stands in no room of House()";
    EXPECT_TRUE(std::regex_match(file, std::regex(headers))) << "clang-tidy does not look at " << file;
  }
}

TEST(House, NoRoomHoldsMoreThanThreeTenths) {
  std::map<std::string, std::size_t> lines;  // of each top-level folder
  std::size_t all = 0;
  for (const std::string& file : Sources()) {
    const std::size_t count = LinesOf(file).size();
    lines[TopOf(file)] += count;
    all += count;
  }
  for (const auto& [room, count] : lines) EXPECT_LE(10 * count, 3 * all) << room;
}

TEST(House, FoldersAreSeenAtAGlance) {
  // Where each source is a row of one table: the commands, the sensors, the questions.
  const std::set<std::string> tables = {"cli/commands", "sim/sensors", "study/questions"};
  std::map<std::string, int> sources;
  for (const std::string& file : Sources()) {
    if (file.ends_with(".cc")) ++sources[fs::path(file).parent_path().string()];
  }
  for (const auto& [folder, count] : sources) {
    if (!tables.contains(folder)) {
      EXPECT_LE(count, 12) << folder;
    }
  }
}

// A floor is the length of the longest chain of includes between top-level folders.
TEST(House, HasAtMostEightFloors) {
  std::map<std::string, std::set<std::string>> below;
  for (const Include& include : Includes()) {
    if (include.quoted && RoomOf(include.target) < House().size() &&
        TopOf(include.target) != TopOf(include.file))
      below[TopOf(include.file)].insert(TopOf(include.target));
  }
  std::map<std::string, int> floors;
  for (const Room& room : House()) {  // from the ground up
    const std::string top = TopOf(room.path);
    if (floors.contains(top)) continue;
    int under = 0;
    for (const std::string& other : below[top]) {
      EXPECT_TRUE(floors.contains(other)) << top << " includes " << other << ", which stands above it";
      under = std::max(under, floors[other]);
    }
    floors[top] = under + 1;
    EXPECT_LE(under + 1, 8) << top;
  }
}

// Past these figures the answer has been "two concepts".
TEST(DependencyRules, FilesHoldOneConcept) {
  for (const std::string& file : Sources()) {
    EXPECT_LE(LinesOf(file).size(), file.ends_with(".h") ? 200U : 500U) << file;
  }
}

TEST(DependencyRules, FunctionsAreReadAtAGlance) {
  constexpr std::size_t kMostLines = 80;
  for (const std::string& file : Sources()) {
    const std::vector<std::string> lines = LinesOf(file);
    std::size_t begin = 0;   // of what stands at the beginning of a line
    std::size_t method = 0;  // of what is indented once
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string& line = lines[i];
      if (line == "}") {
        EXPECT_LE(i + 1 - begin, kMostLines) << file << ":" << begin + 1 << ": " << lines[begin];
      }
      if (line == "  }") {
        EXPECT_LE(i + 1 - method, kMostLines) << file << ":" << method + 1 << ": " << lines[method];
      }
      // A method in a class, or a block in a function, which is no longer than that.
      if (line.size() > 2 && line.starts_with("  ") && line[2] != ' ' && line[2] != '}') method = i;
      const bool begins = !line.empty() && line[0] != ' ' && line[0] != '}' && line[0] != '#';
      if (begins && (i == 0 || lines[i - 1].empty() || lines[i - 1].starts_with("//") || lines[i - 1] == "}"))
        begin = i;
    }
  }
}

}  // namespace
}  // namespace gauntlet
