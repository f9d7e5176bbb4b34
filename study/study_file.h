// A study file as it is written: its tables and keys, each of them known and of its type.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "study/study.h"

namespace gauntlet {

struct StudyFileContent {
  std::map<std::string, std::string> top;
  std::vector<StudyFileTable> tables;
};

// Error: malformed TOML, an unknown key with the nearest known one, a key that is missing, a value that it
// does not take.
Result<StudyFileContent> ReadStudyFile(const std::string& text, const std::string& file);

// "a, b" -> a and b.
std::vector<std::string> ListItems(const std::string& text);

}  // namespace gauntlet
