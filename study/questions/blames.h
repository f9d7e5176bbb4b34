// What the obstacles of a case contribute to its failures: what `gauntlet blame` finds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/figures/blame_figure.h"
#include "analysis/statistics/interval.h"
#include "search/failure_tally.h"
#include "study/questions/question.h"

namespace gauntlet {

// A part of a case: one obstacle, or two.
struct BlamedPart {
  std::vector<std::size_t> obstacles;  // from 0
  FailureTally without;                // how often the case fails without them
  double effect = 0.0;                 // by how much less: a difference of probabilities
  analysis::Interval interval;         // of it (Newcombe 1998, 95 %)
  bool to_blame = false;               // ClearlyLess
  std::uint64_t touched = 0;           // of one obstacle: failing robots that were at it
};

struct Blame {
  std::string name;  // of the case, as in CaseAnswer
  RunId run = 0;     // that it is the case of; 0 when it came from a file
  sim::TestCase test_case;
  FailureTally whole;  // of the case as it is
  std::vector<BlamedPart> singles;
  std::vector<BlamedPart> pairs;     // empty when single obstacles are to blame
  std::uint64_t failing_robots = 0;  // Whereabouts::failing_robots of all runs of the case as it is
  std::vector<sim::Vec2> stuck;      // m: where a robot stayed for 5 s in one of them
  std::uint64_t runs = 0;            // simulated
};
Blame BlameIn(const CaseAnswer& answer);

// Drawn on the case.
analysis::BlameFigure FigureOf(const Blame& blame);
// What it says, in one or two sentences.
std::string DescribeBlame(const Blame& blame);

Question BlameQuestion();

}  // namespace gauntlet
