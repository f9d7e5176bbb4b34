// A corpus: cases that have broken a controller, kept to see whether they still do. A folder with one JSON
// file for each case.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "proto/case_json.h"

namespace gauntlet {

// The newest format of a case's file that this version reads, and the one that it writes.
inline constexpr int kCorpusFormat = 1;

// What a case did: "fail" (in at least half of its runs), "flaky" (in fewer) or "pass" (in none).
inline constexpr const char* kExpectations[] = {"pass", "flaky", "fail"};

struct CorpusCase {
  std::string name;  // of the case in its corpus; its files are called so
  std::string expected = "fail";
  std::string found_in;       // where it comes from, in words
  proto::CaseFailures found;  // how often it failed there, in runs that took no part in choosing it
  // Everything but the case that a run depends on, as --set takes it: {"scenario", "flocking"}.
  std::vector<std::pair<std::string, std::string>> settings;
  proto::CaseDocument document;
};

// The value of a setting; "" when it is not there.
std::string SettingOf(const CorpusCase& one, const std::string& key);

std::string WriteCorpusCase(const CorpusCase& one);
// Error (kInvalidInput): names the file and what is wrong in it; also when a newer version wrote it.
Result<CorpusCase> ParseCorpusCase(const std::string& text, const std::string& file_name);

struct CorpusEntry {
  std::string file;
  CorpusCase content;
};
// All cases in a folder, by the names of their files. Errors: there is no such folder, it is a campaign, or
// no case is in it; two of one name; cases of two scenarios; those of ParseCorpusCase.
Result<std::vector<CorpusEntry>> ReadCorpus(const std::string& directory);

}  // namespace gauntlet
