// Looks into a campaign's database, and damages it, behind the master's back.
#pragma once

#include <string>
#include <vector>

namespace gauntlet::testing_support {

// Every value of every row that a query answers with, one after the other. What is asked is a copy, its
// write-ahead log included: so the campaign may be one whose master was killed, and its files stay as they
// are.
std::vector<std::string> Query(const std::string& dir, const std::string& query);

// The stored runs, "12 2784cf76d5400fa7": ids, in their order, and hashes. The database's triggers see to it
// that none is stored twice.
std::vector<std::string> StoredRuns(const std::string& dir);

// Runs statements after dropping the triggers that guard the rows. Returns how many rows the last one
// changed.
int AlterDatabase(const std::string& dir, const std::string& statements);

}  // namespace gauntlet::testing_support
