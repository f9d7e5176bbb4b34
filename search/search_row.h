// A row of the table of searches: whatever differs from search to search and is not its algorithm.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "base/result.h"
#include "search/experiment/schema.h"
#include "search/search_algorithm.h"
#include "search/search_setup.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

class LayoutQuestion;

// What the individuals are that a search ends with.
enum class Individuals : std::uint8_t {
  kCases,       // each stands for itself
  kPopulation,  // relatives: they stand for one evolution, and some may be equal
  kElites,      // failures that the search has chosen
};
// "cases", "population", "elites".
std::string_view NameOf(Individuals individuals);

struct SearchRow {
  SearchInfo info;  // what experiments may say of it: name, keys, rules between them
  // Part of the key of its random numbers: take the next that no row has. Searches that share one begin with
  // the same random cases. Stored campaigns depend on it: do not renumber.
  std::uint32_t number = 0;
  std::string_view title;  // "genetic search"
  Individuals individuals = Individuals::kCases;
  // What an experiment makes it do, behind the title: "20 test cases x 50 generations".
  std::string (*plan)(const Experiment& experiment) = nullptr;
  // Error: the ranges of genes leave no room for a valid case, or there is nothing to search.
  Result<std::unique_ptr<SearchAlgorithm>> (*make)(SearchSetup setup) = nullptr;
  sim::SeedPurpose purpose = sim::SeedPurpose::kSearch;  // of the seeds of its runs
  // Of a search through SearchSetup::cases, which `command` alone makes: what it asks of a case.
  std::unique_ptr<LayoutQuestion> (*question)(const Experiment& experiment,
                                              const sim::Genome& obstacles) = nullptr;
  bool reads_trajectories = false;      // of runs: they are kept, and told to the question
  std::string_view command = "evolve";  // that begins it
  std::string_view length_option = {};  // of `command`, for info.length; "" = --set has to do
  // The seeds of a run follow from its case, not from its individual's number: a case has the same ones at
  // any place of a list, and so have clones.
  bool seeds_of_cases = false;

  // Runs have settings of their own (EvaluationRequest::settings), which only SpecOfRun knows: nothing that
  // takes the experiment for that of all its runs takes such a search. Cases may be handed to it.
  bool varies_settings = false;

  // Cases are added while it runs (CaseStream), each with settings of its own if it likes.
  bool streamed = false;

  bool counts_contacts = false;  // of its runs (RunSpec::count_contacts)

  bool given_cases() const { return question != nullptr; }
  bool Related() const { return individuals == Individuals::kPopulation; }
  // Its cases are handed to it before it begins.
  bool handed_cases() const { return !streamed && (given_cases() || varies_settings); }
  bool Breeds() const { return Related() && !given_cases(); }
};

// SearchRow::make of a class with a static Create, which takes Options too.
template <typename Search, auto... Options>
Result<std::unique_ptr<SearchAlgorithm>> Make(SearchSetup setup) {
  TRY(auto search, Search::Create(std::move(setup), Options...));
  return std::unique_ptr<SearchAlgorithm>(std::move(search));
}

}  // namespace gauntlet
