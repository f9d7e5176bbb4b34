#include "tests/integration/campaign_database.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <memory>

#include "tests/support/process.h"

namespace gauntlet::testing_support {
namespace {

struct Closer {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, Closer>;

Database Open(const std::string& dir) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open((dir + "/campaign.db").c_str(), &database), SQLITE_OK);
  return Database(database);
}

std::vector<std::string> Execute(sqlite3* database, const std::string& sql) {
  std::vector<std::string> values;
  const auto take = [](void* into, int columns, char** row, char**) {
    for (int column = 0; column < columns; ++column)
      static_cast<std::vector<std::string>*>(into)->emplace_back(row[column]);
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), take, &values, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database) << ": " << sql;
  return values;
}

}  // namespace

std::vector<std::string> Query(const std::string& dir, const std::string& query) {
  const TemporaryDirectory copy;
  for (const char* name : {"/campaign.db", "/campaign.db-wal"}) {
    std::error_code missing;
    std::filesystem::copy_file(dir + name, copy.path() + name, missing);
  }
  return Execute(Open(copy.path()).get(), query);
}

std::vector<std::string> StoredRuns(const std::string& dir) {
  return Query(dir, "SELECT id || ' ' || printf('%016x', hash) FROM runs ORDER BY id");
}

int AlterDatabase(const std::string& dir, const std::string& statements) {
  const Database database = Open(dir);
  const std::string guards =
      "SELECT 'DROP TRIGGER ' || name || ';' FROM sqlite_master WHERE type = 'trigger'";
  for (const std::string& drop : Execute(database.get(), guards)) Execute(database.get(), drop);
  Execute(database.get(), statements);
  return sqlite3_changes(database.get());
}

}  // namespace gauntlet::testing_support
