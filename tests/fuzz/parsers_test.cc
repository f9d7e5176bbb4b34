// The short run: every file of the seed corpus, and thousands of changed ones by a fixed seed.
// `./dev fuzz` is the long one. GAUNTLET_FUZZ_SEED and GAUNTLET_FUZZ_INPUTS ask for others, and more.
#include "tests/fuzz/parsers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/mutation.h"

namespace gauntlet::fuzz {
namespace {

constexpr std::uint64_t kDefaultSeed = 1;
constexpr std::uint64_t kDefaultInputs = 4000;

std::uint64_t Setting(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

// In the order of their names, whatever the file system's.
std::vector<std::string> Corpus(const std::string& name) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(GAUNTLET_FUZZ_CORPUS) + "/" + name))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const std::filesystem::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return corpus;
}

class ParserTest : public testing::TestWithParam<Parser> {};

// Passes by ending: a parser that crashes, hangs or breaks a promise ends this process.
TEST_P(ParserTest, EndsWellOnTheCorpusAndOnWhatComesOfIt) {
  const std::vector<std::string> corpus = Corpus(GetParam().name);
  ASSERT_GE(corpus.size(), 3U);
  for (const std::string& text : corpus) GetParam().read(text);
  const std::uint64_t seed = Setting("GAUNTLET_FUZZ_SEED", kDefaultSeed);
  const std::uint64_t inputs = Setting("GAUNTLET_FUZZ_INPUTS", kDefaultInputs);
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  const std::string last_path = testing::TempDir() + "/gauntlet-fuzz-" + GetParam().name;
  for (std::uint64_t i = 0; i < inputs; ++i) {
    const std::string text = Mutate(corpus, random);
    if (std::getenv("GAUNTLET_FUZZ_KEEP") != nullptr) std::ofstream(last_path, std::ios::binary) << text;
    GetParam().read(text);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ParserTest, testing::ValuesIn(Parsers().begin(), Parsers().end()),
                         [](const testing::TestParamInfo<Parser>& parameter) {
                           return parameter.param.name;
                         });

}  // namespace
}  // namespace gauntlet::fuzz
