// Whether this build has a sanitizer. Its programs take 5 to 20 times as long, have a malloc of their own and
// shadow memory several times their own (Serebryany et al., "AddressSanitizer", 2012; "ThreadSanitizer",
// 2009).
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GAUNTLET_SANITIZED 1
#else
#define GAUNTLET_SANITIZED 0
#endif

namespace gauntlet::testing_support {

inline constexpr bool kSanitized = GAUNTLET_SANITIZED != 0;

}  // namespace gauntlet::testing_support
