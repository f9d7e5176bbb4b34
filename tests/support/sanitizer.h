// Whether this build has a sanitizer. Its programs take 5 to 20 times as long, have a malloc of their own and
// shadow memory several times their own (Serebryany et al., "AddressSanitizer", 2012; "ThreadSanitizer",
// 2009).
#pragma once

// g++ defines macros, clang answers.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GAUNTLET_SANITIZED 1
#elif defined(__has_feature)
#define GAUNTLET_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define GAUNTLET_SANITIZED 0
#endif

namespace gauntlet::testing_support {

inline constexpr bool kSanitized = GAUNTLET_SANITIZED != 0;

}  // namespace gauntlet::testing_support
