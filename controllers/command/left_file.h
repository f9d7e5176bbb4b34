// Files that a program has left.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace gauntlet::controllers::command {

// Opened to read; not opened where there is none, or what is there is no regular file: a named pipe would let
// the reader wait for ever. At its end with `at_end`.
inline std::ifstream OpenLeftFile(const std::string& path, bool at_end = false) {
  std::ifstream file;
  std::error_code failed;
  if (std::filesystem::is_regular_file(path, failed))
    file.open(path, at_end ? std::ios::binary | std::ios::ate : std::ios::binary);
  else
    file.setstate(std::ios::failbit);
  return file;
}

}  // namespace gauntlet::controllers::command
