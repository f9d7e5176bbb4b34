// LOG and LOGERR: standard output and standard error. They are no streams, but take what streams take.
#pragma once

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CARGoSLog {
 public:
  explicit CARGoSLog(std::ostream& stream) : stream_(&stream) {}

  template <typename T>
  CARGoSLog& operator<<(T value) {
    *stream_ << value;
    return *this;
  }
  CARGoSLog& operator<<(std::ostream& (*manipulator)(std::ostream&)) {
    *stream_ << manipulator;
    return *this;
  }
  void Flush() { stream_->flush(); }
  std::ostream& GetStream() { return *stream_; }
  // Nothing is ever coloured.
  void EnableColoredOutput() {}
  void DisableColoredOutput() {}
  bool IsColoredOutput() const { return false; }
  // What follows goes there. A file that cannot be written takes nothing.
  void RedirectToFile(const std::string& name) {
    file_.open(name, std::ios::app);
    stream_ = &file_;
  }

 private:
  std::ostream* stream_;
  std::ofstream file_;
};

extern CARGoSLog LOG;
extern CARGoSLog LOGERR;

}  // namespace argos

// Inside controllers: with the robot's name before it.
#define RLOG LOG << "[" << this->GetId() << "] "
#define RLOGERR LOGERR << "[" << this->GetId() << "] "

// For finding errors: to standard error.
#ifndef DEBUG
#define DEBUG(...) std::fprintf(stderr, __VA_ARGS__)
#endif
#define DEBUG_FUNCTION_ENTER std::fprintf(stderr, "BEGIN %s\n", __PRETTY_FUNCTION__)
#define DEBUG_FUNCTION_EXIT std::fprintf(stderr, "END %s\n", __PRETTY_FUNCTION__)
#define TRACE(STATEMENT)                    \
  std::fprintf(stderr, "%s\n", #STATEMENT); \
  STATEMENT
