// What ARGoS' interface throws, and the macros that throw it.
#pragma once

#include <exception>
#include <sstream>
#include <string>

namespace argos {

class CARGoSException : public std::exception {
 public:
  // what() is "[FATAL] " and the text; of a nested one its what() follows on a line of its own.
  explicit CARGoSException(const std::string& text, std::exception* nested = nullptr)
      : text_("[FATAL] " + text) {
    if (nested != nullptr) text_.append("\n").append(nested->what());
  }
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

}  // namespace argos

// Both take what may stand right of `stream <<`, and are blocks: a semicolon may follow.
#define THROW_ARGOSEXCEPTION(MESSAGE)         \
  {                                           \
    std::ostringstream what;                  \
    what << MESSAGE;                          \
    throw argos::CARGoSException(what.str()); \
  }
#define THROW_ARGOSEXCEPTION_NESTED(MESSAGE, NESTED)     \
  {                                                      \
    std::ostringstream what;                             \
    what << MESSAGE;                                     \
    throw argos::CARGoSException(what.str(), &(NESTED)); \
  }

#ifdef NDEBUG
#define ARGOS_ASSERT(CONDITION, MESSAGE)
#else
#define ARGOS_ASSERT(CONDITION, MESSAGE) \
  if (!(CONDITION)) THROW_ARGOSEXCEPTION("Assertion failed: " << #CONDITION << ": " << MESSAGE)
#endif
