// Errors as values: bad input from outside is answered with a Result, never with an exception.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/check.h"

namespace gauntlet {

enum class ErrorKind {
  kInvalidInput,  // a file, a message or an argument is wrong; the message names the value and what would be
                  // right
  kNotFound,
  kIo,
  kNoSpace,   // the disk is full
  kCorrupt,   // stored data does not read back
  kInUse,     // another living process owns it
  kVersion,   // made by a newer or an incompatible version
  kInternal,  // a defect of ours
};

struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string message;  // one line, names the offending value and its place
};

inline Error InvalidInput(std::string message) {
  return {ErrorKind::kInvalidInput, std::move(message)};
}

// A value or an Error. Value() on an error aborts with its message.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }

  const T& value() const& {
    GAUNTLET_CHECK(ok(), error_.message);
    return *value_;
  }
  T& value() & {
    GAUNTLET_CHECK(ok(), error_.message);
    return *value_;
  }
  T&& value() && {
    GAUNTLET_CHECK(ok(), error_.message);
    return *std::move(value_);
  }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

  const Error& error() const& {
    GAUNTLET_CHECK(!ok(), "Result::error() called on a value");
    return error_;
  }
  Error&& error() && {
    GAUNTLET_CHECK(!ok(), "Result::error() called on a value");
    return std::move(error_);
  }

 private:
  // Not a variant: hundreds of types are results, and this compiles faster.
  std::optional<T> value_;
  Error error_;
};

struct Ok {};
// Success, or an Error.
using Status = Result<Ok>;

}  // namespace gauntlet

// Passes the error of a Result on to the caller, in a function that returns a Result:
//   TRY(Flush());                   returns its error, if it has one
//   TRY(const auto rows, Read());   otherwise declares `rows` with the value; Read() may hold commas
//   TRY(rows, Read());              or assigns it
// A statement for a block in braces: as the only statement of an `if` or a loop without them it does not
// compile.
#define TRY(first, ...) GAUNTLET_TRY_##__VA_OPT__(VALUE)(__LINE__, first __VA_OPT__(, ) __VA_ARGS__)
#define GAUNTLET_TRY_(line, result) GAUNTLET_TRY_RESULT(line, result)
#define GAUNTLET_TRY_VALUE(line, target, ...) \
  GAUNTLET_TRY_RESULT(line, __VA_ARGS__);     \
  target = *std::move(GAUNTLET_TRIED(line))
#define GAUNTLET_TRY_RESULT(line, ...)       \
  auto GAUNTLET_TRIED(line) = (__VA_ARGS__); \
  if (!GAUNTLET_TRIED(line).ok()) return std::move(GAUNTLET_TRIED(line)).error()
#define GAUNTLET_TRIED(line) GAUNTLET_TRIED_LINE(line)
#define GAUNTLET_TRIED_LINE(line) tried_##line
