#include "study/questions/smallest_layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "base/system/atomic_file.h"
#include "study/questions/case_answer.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = "-minimised";

// The run whose case the file holds what is left of; 0 when it is another file.
RunId RunOfFile(const fs::path& file) {
  std::string name = file.stem().string();
  if (file.extension() != ".json" || !name.ends_with(kEnding)) return 0;
  name.erase(name.size() - std::string_view(kEnding).size());
  if (const std::size_t after_run = name.find('-'); after_run != std::string::npos) name[after_run] = ' ';
  std::ranges::replace(name, '-', ':');
  return RunOfName(name);
}

std::size_t Obstacles(const SmallestLayout& one) {
  return one.document.test_case.obstacles.size();
}

}  // namespace

std::string FileNameOf(const std::string& case_name) {
  const bool of_run = RunOfName(case_name) > 0;
  std::string name = of_run ? case_name : fs::path(case_name).stem().string();
  std::ranges::replace_if(
      name, [&](char c) { return c == ' ' || c == '/' || (of_run && c == ':'); }, '-');
  return name;
}

std::string SmallestLayoutFile(const std::string& directory, const std::string& case_name) {
  return fmt::format("{}/{}{}", directory, FileNameOf(case_name), kEnding);
}

Result<std::vector<SmallestLayout>> ReadSmallestLayouts(const std::string& dir) {
  std::map<RunId, SmallestLayout> smallest;
  for (const std::string& call : CallsIn(dir + kMinimiseFolder)) {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(call, none)) {
      const std::string file = entry.path().string();
      const RunId run = RunOfFile(file);
      if (run == 0) continue;
      TRY(const auto text, ReadSmallFile(file));
      TRY(auto document, proto::ParseCaseDocument(text, file));
      if (!document.lineage) continue;  // somebody else's
      SmallestLayout one{run, file, std::move(document)};
      const auto [known, is_new] = smallest.try_emplace(run, one);
      if (!is_new && Obstacles(one) < Obstacles(known->second)) known->second = std::move(one);
    }
  }
  std::vector<SmallestLayout> all;
  for (auto& [run, one] : smallest) all.push_back(std::move(one));
  return all;
}

std::vector<const SmallestLayout*> SmallestFirst(const std::vector<SmallestLayout>& layouts,
                                                 std::size_t most) {
  std::vector<const SmallestLayout*> first;
  for (const SmallestLayout& one : layouts) first.push_back(&one);
  std::ranges::stable_sort(first, {}, [](const SmallestLayout* one) {
    return std::pair(one->document.test_case.obstacles.size(), -one->document.lineage->verified.failures);
  });
  first.resize(std::min(first.size(), most));
  return first;
}

}  // namespace gauntlet
