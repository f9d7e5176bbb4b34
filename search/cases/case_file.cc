#include "search/cases/case_file.h"

#include <cstddef>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/system/atomic_file.h"
#include "proto/case_json.h"
#include "search/cases/corpus_file.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostBytes = 16U << 20;

Result<std::string> ReadFile(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return Error{ErrorKind::kNotFound, fmt::format("{}: no such file", path.string())};
  }
  if (std::filesystem::is_directory(status)) {
    return InvalidInput(
        fmt::format("{} is a directory, expected a case file (.json or .argos)", path.string()));
  }
  const std::string name = path.string();
  if (std::filesystem::is_fifo(status) && !name.starts_with("/dev/") && !name.starts_with("/proc/"))
    return InvalidInput(name + " is a named pipe, whose writer may never come: give the case by /dev/stdin");
  Result<std::string> text = ReadSmallFile(name, kMostBytes);
  if (!text && text.error().kind == ErrorKind::kCorrupt) {
    return InvalidInput(
        fmt::format("{} has more than {} bytes, the most for a case file", path.string(), kMostBytes));
  }
  return text;
}

bool IsArgos(const std::filesystem::path& path, const std::string& text) {
  const std::string extension = path.extension().string();
  if (extension == ".argos" || extension == ".xml") return true;
  if (extension == ".json") return false;
  const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string::npos && text[first] == '<';
}

}  // namespace

Result<LoadedCase> LoadCase(const std::filesystem::path& path) {
  TRY(const auto text, ReadFile(path));
  LoadedCase loaded;
  if (IsArgos(path, text)) {
    TRY(loaded, ParseArgos(text, path.string()));
    loaded.test_case.name = path.filename().string();
  } else {
    Result<proto::CaseDocument> parsed = proto::ParseCaseDocument(text, path.string());
    if (!parsed) {
      Result<CorpusCase> kept = ParseCorpusCase(text, path.string());
      if (!kept) return parsed.error();
      parsed = std::move(kept->document);
    }
    loaded.test_case = std::move(parsed->test_case);
    loaded.lineage = std::move(parsed->lineage);
    if (loaded.test_case.name.empty()) loaded.test_case.name = path.filename().string();
  }
  return loaded;
}

}  // namespace gauntlet
