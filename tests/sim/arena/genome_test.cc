#include "sim/arena/genome.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/sim/arena/random_genomes.h"

namespace gauntlet::sim {
namespace {

RC_GTEST_PROP(GenomeCodec, WhatIsEncodedDecodesToTheSame, ()) {
  const Genome genome = ArbitraryGenome();
  CanonicalEncoder encoder;
  EncodeGenome(genome, encoder);
  encoder.Uint(7);
  CanonicalDecoder decoder(encoder.bytes());
  RC_ASSERT(DecodeGenome(decoder) == genome);
  RC_ASSERT(decoder.Uint() == 7u);
  RC_ASSERT(decoder.ok());
  RC_ASSERT(decoder.AtEnd());
}

RC_GTEST_PROP(GenomeCodec, WhatIsCutOffIsNotOk, ()) {
  CanonicalEncoder encoder;
  EncodeGenome(ArbitraryGenome(), encoder);
  const auto length = *rc::gen::inRange<std::size_t>(0, encoder.bytes().size());
  CanonicalDecoder decoder(std::string_view(encoder.bytes()).substr(0, length));
  DecodeGenome(decoder);
  RC_ASSERT(!decoder.ok());
}

// Stored campaigns depend on these bytes.
TEST(GenomeCodec, PlainObstaclesHaveTheBytesTheyAlwaysHad) {
  const Genome genome = {{1.0, 2.0, 0.5, 0.1, 45.0}, {0.1, -1.0, 0.7, 0.2, 359.0}};
  CanonicalEncoder expected;
  expected.Uint(2);
  for (const double value : {1.0, 2.0, 0.5, 0.1, 45.0, 0.1, -1.0, 0.7, 0.2, 359.0}) expected.Double(value);
  CanonicalEncoder encoder;
  EncodeGenome(genome, encoder);
  EXPECT_EQ(encoder.bytes(), expected.bytes());
}

TEST(GenomeCodec, EveryFieldCountsInTheHash) {
  Genome genome = {{1.0, 2.0, 0.5, 0.1, 45.0}};
  const std::uint64_t plain = GenomeHash(genome);
  genome[0].light = Color::kRed;
  const std::uint64_t lit = GenomeHash(genome);
  genome[0].path = {{1.0, 1.0}};
  genome[0].speed = 0.02;
  const std::uint64_t moving = GenomeHash(genome);
  genome[0].speed = 0.03;
  EXPECT_NE(plain, lit);
  EXPECT_NE(lit, moving);
  EXPECT_NE(moving, GenomeHash(genome));
}

}  // namespace
}  // namespace gauntlet::sim
