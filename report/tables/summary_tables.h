// What a campaign's summary says in tables.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/tables/table.h"
#include "master/campaign/campaign_summary.h"

namespace gauntlet {

// Cells of an archive, filled or not.
std::size_t CellsOf(const ArchiveView& archive);
// A part of an axis: "-3 to -1.8".
std::string RangeText(const controllers::DescriptorAxis& axis, int part);
// Of the population that the summary tells of, which holds every archived failure.
const PopulationMember& MemberOf(const SearchSummary& summary, const ArchivedFailure& failure);

// The archive's failures, those with the fewest and shortest obstacles first.
std::vector<const PopulationMember*> SmallestFirst(const SearchSummary& summary);

// The case that a campaign points at: the toughest of the populations, of an archive its smallest failure.
struct ToughestCase {
  const PopulationMember* member = nullptr;
  RunId run = 0;             // its latest; of an archive that in which it failed first
  std::size_t as_tough = 1;  // cases with the same fitness, it included
};
// None before the first result.
std::optional<ToughestCase> ToughestCaseOf(const CampaignSummary& summary);

// Facts of one search, or of all (`only` is nullptr: without a fitness, which each has of its own), added to
// a table of names and texts.
void AddTally(const SearchTally& tally, const SearchSummary* only, Table& table);
// Of a campaign whose runs start a program of the user's: whether they end the same once more.
void AddReproducibility(const CampaignSummary& summary, Table& table);
// What a reader has to know before trusting a figure, a sentence each.
std::vector<std::string> WarningsOf(const CampaignSummary& summary);
// Of a campaign with controllers of plug-ins: what is to blame when results differ.
std::string WhyNotReproducible(const CampaignSummary& summary);

// A row for each of the first searches of a sweep.
Table SearchesTable(const CampaignSummary& summary, std::size_t most);
// A row for each generation.
Table GenerationTable(const SearchSummary& summary);
// A row for each of these members; `named`: they are given cases.
Table PopulationTable(const std::vector<const PopulationMember*>& members, bool named);
// A row for each type that the scenario declares.
Table FailureTypeTable(const SearchSummary& summary);
// A row for each failure that the archive keeps, the smallest first; `replay`: how the command begins that
// shows one.
Table ArchiveTable(const SearchSummary& summary, const std::string& replay = "");
// The fewest obstacles of each cell, the second axis upwards, the first one to the right. Of two axes.
Table ArchiveMap(const SearchSummary& summary);

}  // namespace gauntlet
