// What reads bytes that others have written, each as one function that must end, and end well, whatever it is
// given. Every target of libFuzzer calls one of them, and so does the short run in the suite.
#pragma once

#include <ostream>
#include <span>
#include <string>
#include <string_view>

namespace gauntlet::fuzz {

struct Parser {
  std::string name;  // of its folder in tests/fuzz/corpus and of its libFuzzer target, fuzz_NAME
  // Reads, and checks what must hold of everything that was accepted; aborts when it does not.
  void (*read)(std::string_view bytes);
};

std::span<const Parser> Parsers();

// For GoogleTest, which would print the bytes of a Parser.
inline void PrintTo(const Parser& parser, std::ostream* out) {
  *out << parser.name;
}

}  // namespace gauntlet::fuzz
