// What of ARGoS' simulator a controller cannot have in Gauntlet. Sources that only include its headers
// compile; what uses one of these functions does not, and the compiler says what to do instead.
#pragma once

namespace argos {

template <typename Use>
inline constexpr bool kAvailable = false;

}  // namespace argos

// A function with that name and any arguments.
#define ARGOS_UNAVAILABLE(RESULT, NAME, ADVICE)               \
  template <typename Use = void, typename... Arguments>       \
  RESULT NAME(Arguments&&...) const {                         \
    static_assert(argos::kAvailable<Use>, #NAME ": " ADVICE); \
    throw 0;                                                  \
  }
