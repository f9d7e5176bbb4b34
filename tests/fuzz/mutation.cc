#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace gauntlet::fuzz {
namespace {

constexpr std::size_t kMostBytes = 64U << 10;

constexpr std::array<std::string_view, 34> kStumblingBlocks = {"0",
                                                               "-1",
                                                               "1e999",
                                                               "-1e-999",
                                                               "nan",
                                                               "inf",
                                                               "18446744073709551616",
                                                               "0x7fffffff",
                                                               "\"",
                                                               "'",
                                                               "\\",
                                                               "\n",
                                                               "{",
                                                               "}",
                                                               "[",
                                                               "]",
                                                               "<",
                                                               ">",
                                                               "&amp;",
                                                               "<!--",
                                                               "]]>",
                                                               "null",
                                                               "true",
                                                               "\xff\xfe",
                                                               "\xef\xbb\xbf",
                                                               "\xed\xa0\x80",
                                                               "\\ud800",
                                                               "\xff\xff\xff\xff\x0f",
                                                               "\x80\x80\x80\x80\x80\x80\x80\x80\x80\x02",
                                                               "=",
                                                               "#",
                                                               ".",
                                                               ",",
                                                               "\t"};

std::size_t Place(const std::string& text, sim::RandomStream& random) {
  return random.Below(static_cast<std::uint32_t>(text.size() + 1));
}

// A piece, short rather than long.
std::pair<std::size_t, std::size_t> Piece(const std::string& text, sim::RandomStream& random) {
  const std::size_t begin = Place(text, random);
  const std::uint32_t most = 1U << random.Below(12);
  const std::size_t length = random.Below(most) + 1;
  return {begin, std::min(length, text.size() - begin)};
}

void ChangeOnce(std::string& text, const std::vector<std::string>& corpus, sim::RandomStream& random) {
  const std::uint32_t kind = random.Below(8);
  const std::size_t place = Place(text, random);
  const auto [begin, length] = Piece(text, random);
  switch (kind) {
    case 0:
      if (place < text.size()) text[place] = static_cast<char>(text[place] ^ (1 << random.Below(8)));
      break;
    case 1:
      if (place < text.size()) text[place] = static_cast<char>(random.Below(256));
      break;
    case 2:
      text.erase(begin, length);
      break;
    case 3:
      text.insert(place, text.substr(begin, length));
      break;
    case 4: {
      const std::string& other = corpus[random.Below(static_cast<std::uint32_t>(corpus.size()))];
      const auto [from, size] = Piece(other, random);
      text.insert(place, other, from, size);
      break;
    }
    case 5:
      text.insert(place, kStumblingBlocks[random.Below(kStumblingBlocks.size())]);
      break;
    case 6:
      text.replace(begin, length, kStumblingBlocks[random.Below(kStumblingBlocks.size())]);
      break;
    default: {
      // Deep nesting, long repetitions.
      const std::string piece = text.substr(begin, std::min<std::size_t>(length, 16));
      const std::uint32_t times = 1U << random.Below(10);
      std::string repeated;
      for (std::uint32_t i = 0; i < times; ++i) repeated += piece;
      text.insert(place, repeated);
    }
  }
  if (text.size() > kMostBytes) text.resize(kMostBytes);
}

}  // namespace

std::string Mutate(const std::vector<std::string>& corpus, sim::RandomStream& random) {
  std::string text = corpus[random.Below(static_cast<std::uint32_t>(corpus.size()))];
  const std::uint32_t changes = random.Below(8) + 1;
  for (std::uint32_t i = 0; i < changes; ++i) ChangeOnce(text, corpus, random);
  return text;
}

}  // namespace gauntlet::fuzz
