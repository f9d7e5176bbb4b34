// The cases that commands ask about by --on: random ones, those of a corpus, those of campaigns.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

struct ChosenCases {
  // Cases that were chosen together; those of one evolution's population are relatives.
  struct Group {
    std::string place;  // where they come from; "" = drawn
    bool related = false;
    std::vector<sim::TestCase> cases = {};  // named
  };
  std::string words;  // "200 random cases of seed 1"
  std::vector<Group> groups;
  std::vector<std::string> notes;  // what a reader has to know, a sentence each
};

// `on`: "random:N", drawn by the experiment's rules from its seed, those that `gauntlet random` simulates;
// "corpus:DIR"; or DIR[:SUBSET], several with commas in between. Errors: of reading; no such number; cases of
// another scenario.
Result<ChosenCases> ChooseCases(const std::string& on, const Experiment& experiment);

// Random cases, as ChooseCases draws them.
Result<std::vector<sim::TestCase>> DrawRandomCases(const Experiment& experiment, int count);

}  // namespace gauntlet
