#include "master/store/sqlite_tables.h"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <utility>

#include "base/canonical_encoder.h"
#include "base/hash.h"
#include "sim/arena/genome.h"

namespace gauntlet::master {
namespace {

constexpr std::string_view kRunColumns =
    "id, search, individual, evaluation, replicate, generation, seed, spec_hash, hash, verdict, "
    "fitness_bits, "
    "total_failure, "
    "failure_type, worker, attempt, spec, result";

// What the search left out: how it was judged changes with every evaluation and follows from the runs.
std::string EncodeParents(const Individual& individual) {
  CanonicalEncoder encoder;
  encoder.Uint(individual.parents.size());
  for (const IndividualId parent : individual.parents) encoder.Uint(parent);
  return encoder.Take();
}

std::string EncodeTestCase(const sim::TestCase& test_case) {
  CanonicalEncoder encoder;
  encoder.String(test_case.name);
  for (const double value : {test_case.side_x, test_case.side_y, test_case.wall_thickness})
    encoder.Double(value);
  sim::EncodeGenome(test_case.obstacles, encoder);
  encoder.Bool(test_case.spawn_area.has_value());
  if (test_case.spawn_area) {
    const sim::Rectangle& area = *test_case.spawn_area;
    encoder.Double(area.min.x());
    encoder.Double(area.min.y());
    encoder.Double(area.max.x());
    encoder.Double(area.max.y());
  }
  encoder.Bool(test_case.robots.has_value());
  if (test_case.robots) encoder.Int(*test_case.robots);
  return encoder.Take();
}

bool DecodeParents(std::string_view bytes, Individual& individual) {
  CanonicalDecoder decoder(bytes);
  const std::uint64_t count = decoder.Uint();
  for (std::uint64_t i = 0; i < count && decoder.ok(); ++i) individual.parents.push_back(decoder.Uint());
  return decoder.ok() && decoder.AtEnd();
}

bool DecodeTestCase(std::string_view bytes, sim::TestCase& test_case) {
  CanonicalDecoder decoder(bytes);
  test_case.name = decoder.String();
  for (double* value : {&test_case.side_x, &test_case.side_y, &test_case.wall_thickness})
    *value = decoder.Double();
  test_case.obstacles = sim::DecodeGenome(decoder);
  if (decoder.Bool()) {
    sim::Rectangle& area = test_case.spawn_area.emplace();
    for (sim::Vec2* corner : {&area.min, &area.max}) {
      const auto x = decoder.Double();
      const auto y = decoder.Double();
      *corner = sim::Vec2(x, y);
    }
  }
  if (decoder.Bool()) test_case.robots = static_cast<int>(decoder.Int());
  return decoder.ok() && decoder.AtEnd();
}

// Pages carry no checksums; a state whose bits have turned would lead the whole search astray.
std::uint64_t ChecksumOf(const SavedState& state) {
  Fnv1a64 hash;
  hash.AddUint64(state.search);
  hash.AddUint64(state.last_run);
  hash.AddUint64(state.generation);
  hash.AddUint64(state.state.size());
  hash.AddBytes(state.state);
  hash.AddBytes(state.results_digest);
  return hash.value();
}

StoredRun ReadRun(const SqliteStatement& row) {
  StoredRun run;
  int column = 0;
  run.id = row.Uint(column++);
  run.search = static_cast<SearchId>(row.Uint(column++));
  run.individual = row.Uint(column++);
  run.evaluation = static_cast<std::uint32_t>(row.Uint(column++));
  run.replicate = static_cast<std::uint32_t>(row.Uint(column++));
  run.generation = static_cast<std::uint32_t>(row.Uint(column++));
  run.seed = row.Uint(column++);
  run.spec_hash = row.Uint(column++);
  run.hash = row.Uint(column++);
  run.verdict = static_cast<int>(row.Int(column++));
  run.fitness = std::bit_cast<double>(row.Uint(column++));
  run.total_failure = row.Int(column++) != 0;
  run.failure_type = static_cast<int>(row.Int(column++));
  run.worker = row.Bytes(column++);
  run.attempt = static_cast<std::uint32_t>(row.Uint(column++));
  run.spec = row.Bytes(column++);
  run.result = row.Bytes(column++);
  return run;
}

Error Conflict(const std::string& what) {
  return {ErrorKind::kCorrupt, what + " is stored already, with other content"};
}

}  // namespace

Result<SqliteTables> SqliteTables::Open(SqliteConnection& connection) {
  SqliteTables tables(connection);
  const std::pair<SqliteStatement*, const char*> statements[] = {
      {&tables.insert_search_, "INSERT INTO searches (id, name, algorithm, seed) VALUES (?, ?, ?, ?)"},
      {&tables.insert_individual_,
       "INSERT INTO individuals (search, id, birth_generation, parents, test_case) VALUES (?, ?, ?, ?, ?) "
       "ON CONFLICT DO NOTHING"},
      {&tables.insert_run_,
       "INSERT INTO runs (id, search, individual, evaluation, replicate, generation, seed, spec_hash, hash, "
       "verdict, "
       "fitness, "
       "fitness_bits, total_failure, failure_type, worker, attempt, spec, result) "
       "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      {&tables.insert_state_,
       "INSERT INTO states (search, last_run, generation, state, results_digest, checksum) VALUES (?, ?, ?, "
       "?, ?, ?) "
       "ON CONFLICT DO NOTHING"},
      {&tables.insert_event_, "INSERT INTO events (unix_ms, kind, text) VALUES (?, ?, ?)"},
      {&tables.insert_finished_, "INSERT INTO finished (search) VALUES (?) ON CONFLICT DO NOTHING"},
      {&tables.select_individual_,
       "SELECT birth_generation, parents, test_case FROM individuals WHERE search = ? AND id = ?"},
  };
  for (const auto& [statement, sql] : statements) {
    Result<SqliteStatement> prepared = connection.Prepare(sql);
    if (!prepared) return prepared.error();
    *statement = *std::move(prepared);
  }
  return tables;
}

void SqliteTables::Rollback() {
  // An error here means that SQLite has rolled back by itself.
  (void)connection_->Execute("ROLLBACK");
}

Status SqliteTables::Insert(const StoredSearch& search) {
  insert_search_.BindUint(0, search.id);
  insert_search_.BindText(1, search.name);
  insert_search_.BindText(2, search.algorithm);
  insert_search_.BindUint(3, search.seed);
  if (Status inserted = insert_search_.Run(); !inserted) return inserted;
  return search.finished ? InsertFinished(search.id) : Ok{};
}

Status SqliteTables::Insert(SearchId search, const Individual& individual) {
  const std::string parents = EncodeParents(individual);
  const std::string test_case = EncodeTestCase(individual.test_case);
  insert_individual_.BindUint(0, search);
  insert_individual_.BindUint(1, individual.id);
  insert_individual_.BindUint(2, individual.birth_generation);
  insert_individual_.BindBlob(3, parents);
  insert_individual_.BindBlob(4, test_case);
  if (Status inserted = insert_individual_.Run(); !inserted) return inserted;
  if (connection_->Changes() > 0) return Ok{};

  select_individual_.BindUint(0, search);
  select_individual_.BindUint(1, individual.id);
  Result<bool> row = select_individual_.Step();
  const bool same = row.ok() && *row && select_individual_.Uint(0) == individual.birth_generation &&
                    select_individual_.Bytes(1) == parents && select_individual_.Bytes(2) == test_case;
  select_individual_.Reset();
  if (!row) return row.error();
  if (!same) return Conflict(fmt::format("individual {} of search {}", individual.id, search));
  return Ok{};
}

Status SqliteTables::Insert(const StoredRun& run) {
  int index = 0;
  insert_run_.BindUint(index++, run.id);
  insert_run_.BindUint(index++, run.search);
  insert_run_.BindUint(index++, run.individual);
  insert_run_.BindUint(index++, run.evaluation);
  insert_run_.BindUint(index++, run.replicate);
  insert_run_.BindUint(index++, run.generation);
  insert_run_.BindUint(index++, run.seed);
  insert_run_.BindUint(index++, run.spec_hash);
  insert_run_.BindUint(index++, run.hash);
  insert_run_.BindInt(index++, run.verdict);
  insert_run_.BindDouble(index++, run.fitness);
  insert_run_.BindUint(index++, std::bit_cast<std::uint64_t>(run.fitness));
  insert_run_.BindInt(index++, run.total_failure ? 1 : 0);
  insert_run_.BindInt(index++, run.failure_type);
  insert_run_.BindText(index++, run.worker);
  insert_run_.BindUint(index++, run.attempt);
  insert_run_.BindBlob(index++, run.spec);
  insert_run_.BindBlob(index++, run.result);
  return insert_run_.Run();
}

Status SqliteTables::Insert(const SavedState& state) {
  insert_state_.BindUint(0, state.search);
  insert_state_.BindUint(1, state.last_run);
  insert_state_.BindUint(2, state.generation);
  insert_state_.BindBlob(3, state.state);
  insert_state_.BindBlob(4, state.results_digest);
  insert_state_.BindUint(5, ChecksumOf(state));
  if (Status inserted = insert_state_.Run(); !inserted) return inserted;
  if (connection_->Changes() > 0) return Ok{};

  Result<std::optional<SavedState>> stored = LoadState(state.search, state.last_run);
  if (!stored) return stored.error();
  if (!stored->has_value() || ChecksumOf(**stored) != ChecksumOf(state)) {
    return Conflict(fmt::format("the state of search {} after run {}", state.search, state.last_run));
  }
  return Ok{};
}

Status SqliteTables::Insert(const StoredEvent& event) {
  insert_event_.BindInt(0, event.unix_ms);
  insert_event_.BindText(1, event.kind);
  insert_event_.BindText(2, event.text);
  return insert_event_.Run();
}

Status SqliteTables::InsertFinished(SearchId search) {
  insert_finished_.BindUint(0, search);
  return insert_finished_.Run();
}

Result<std::vector<StoredSearch>> SqliteTables::LoadSearches() {
  Result<SqliteStatement> query = connection_->Prepare(
      "SELECT id, name, algorithm, seed, EXISTS (SELECT 1 FROM finished WHERE search = searches.id) "
      "FROM searches ORDER BY id");
  if (!query) return query.error();
  std::vector<StoredSearch> searches;
  while (true) {
    Result<bool> row = query->Step();
    if (!row) return row.error();
    if (!*row) return searches;
    searches.push_back({static_cast<SearchId>(query->Uint(0)), query->Bytes(1), query->Bytes(2),
                        query->Uint(3), query->Int(4) != 0});
  }
}

Result<std::vector<Individual>> SqliteTables::LoadIndividuals(SearchId search) {
  Result<SqliteStatement> query = connection_->Prepare(
      "SELECT id, birth_generation, parents, test_case FROM individuals WHERE search = ? ORDER BY id");
  if (!query) return query.error();
  query->BindUint(0, search);
  std::vector<Individual> individuals;
  while (true) {
    Result<bool> row = query->Step();
    if (!row) return row.error();
    if (!*row) return individuals;
    Individual& individual = individuals.emplace_back();
    individual.id = query->Uint(0);
    individual.birth_generation = static_cast<std::uint32_t>(query->Uint(1));
    if (!DecodeParents(query->Bytes(2), individual) ||
        !DecodeTestCase(query->Bytes(3), individual.test_case)) {
      return Error{ErrorKind::kCorrupt,
                   fmt::format("individual {} of search {} does not read back", individual.id, search)};
    }
  }
}

Result<std::optional<SavedState>> SqliteTables::LoadState(SearchId search, RunId until) {
  Result<SqliteStatement> query = connection_->Prepare(
      "SELECT search, last_run, generation, state, results_digest, checksum FROM states "
      "WHERE search = ? AND last_run <= ? ORDER BY last_run DESC LIMIT 1");
  if (!query) return query.error();
  query->BindUint(0, search);
  query->BindUint(1, until);
  Result<bool> row = query->Step();
  if (!row) return row.error();
  if (!*row) return std::optional<SavedState>();
  SavedState state;
  state.search = static_cast<SearchId>(query->Uint(0));
  state.last_run = query->Uint(1);
  state.generation = static_cast<std::uint32_t>(query->Uint(2));
  state.state = query->Bytes(3);
  state.results_digest = query->Bytes(4);
  if (query->Uint(5) != ChecksumOf(state)) {
    return Error{ErrorKind::kCorrupt,
                 fmt::format("the state of search {} after run {} is damaged: its checksum differs",
                             state.search, state.last_run)};
  }
  return std::optional<SavedState>(std::move(state));
}

Result<std::optional<SavedState>> SqliteTables::LoadNewestState(SearchId search) {
  return LoadState(search, std::numeric_limits<std::int64_t>::max());
}

Status SqliteTables::ForEachRun(SearchId search, RunId after,
                                const std::function<void(const StoredRun&)>& visit) {
  Result<SqliteStatement> query = connection_->Prepare(
      fmt::format("SELECT {} FROM runs WHERE search = ? AND id > ? ORDER BY id", kRunColumns));
  if (!query) return query.error();
  query->BindUint(0, search);
  query->BindUint(1, after);
  while (true) {
    Result<bool> row = query->Step();
    if (!row) return row.error();
    if (!*row) return Ok{};
    visit(ReadRun(*query));
  }
}

Result<std::optional<StoredRun>> SqliteTables::LoadRun(RunId run) {
  Result<SqliteStatement> query =
      connection_->Prepare(fmt::format("SELECT {} FROM runs WHERE id = ?", kRunColumns));
  if (!query) return query.error();
  query->BindUint(0, run);
  Result<bool> row = query->Step();
  if (!row) return row.error();
  if (!*row) return std::optional<StoredRun>();
  return std::optional<StoredRun>(ReadRun(*query));
}

Result<std::vector<StoredEvent>> SqliteTables::LoadEvents() {
  Result<SqliteStatement> query = connection_->Prepare("SELECT unix_ms, kind, text FROM events ORDER BY id");
  if (!query) return query.error();
  std::vector<StoredEvent> events;
  while (true) {
    Result<bool> row = query->Step();
    if (!row) return row.error();
    if (!*row) return events;
    events.push_back({query->Int(0), query->Bytes(1), query->Bytes(2)});
  }
}

}  // namespace gauntlet::master
