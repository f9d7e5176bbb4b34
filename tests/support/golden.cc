#include "tests/support/golden.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace gauntlet::testing_support {
namespace {

void Write(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

void ExpectGolden(const std::string& file, const std::string& text) {
  const std::string golden = GAUNTLET_SOURCE_DIR "/" + file;
  std::ifstream stream(golden, std::ios::binary);
  const std::string expected{std::istreambuf_iterator<char>(stream), {}};
  if (text == expected) return;
  if (std::getenv("GAUNTLET_WRITE_GOLDENS") != nullptr) return Write(golden, text);
  const TemporaryDirectory scratch;
  Write(scratch / "found", text);
  ADD_FAILURE() << RunProcess({"/usr/bin/env", "diff", "-u", "--label", file, "--label", "found",
                               stream.is_open() ? golden : "/dev/null", scratch / "found"})
                       .out
                << "Meant to be so? GAUNTLET_WRITE_GOLDENS=1 before the test's command writes the file anew.";
}

}  // namespace gauntlet::testing_support
