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
    "fitness_bits, total_failure, failure_type, worker, attempt, spec, result";

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
  std::uint64_t fitness_bits = 0;
  row.Read(run.id, run.search, run.individual, run.evaluation, run.replicate, run.generation, run.seed,
           run.spec_hash, run.hash, run.verdict, fitness_bits, run.total_failure, run.failure_type,
           run.worker, run.attempt, run.spec, run.result);
  run.fitness = std::bit_cast<double>(fitness_bits);
  return run;
}

Error Conflict(const std::string& what) {
  return {ErrorKind::kCorrupt, what + " is stored already, with other content"};
}

}  // namespace

Result<SqliteTables> SqliteTables::Open(SqliteConnection& connection) {
  SqliteTables tables(connection);
  const std::pair<SqliteStatement*, std::string> statements[] = {
      {&tables.insert_search_, "INSERT INTO searches (id, name, algorithm, seed) VALUES (?, ?, ?, ?)"},
      {&tables.insert_individual_,
       "INSERT INTO individuals (search, id, birth_generation, parents, test_case) VALUES (?, ?, ?, ?, ?) "
       "ON CONFLICT DO NOTHING"},
      {&tables.insert_run_, fmt::format("INSERT INTO runs ({}, fitness) "
                                        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                                        kRunColumns)},
      {&tables.insert_state_,
       "INSERT INTO states (search, last_run, generation, state, results_digest, checksum) "
       "VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
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
  const Status inserted = insert_search_.Run(search.id, search.name, search.algorithm, search.seed);
  return inserted && search.finished ? Insert(Finished{search.id}) : inserted;
}

Status SqliteTables::Insert(const Newborns& newborns) {
  for (const Individual& individual : newborns.individuals) {
    if (Status inserted = Insert(newborns.search, individual); !inserted) return inserted;
  }
  return Ok{};
}

Status SqliteTables::Insert(SearchId search, const Individual& individual) {
  const std::string parents = EncodeParents(individual);
  const std::string test_case = EncodeTestCase(individual.test_case);
  if (Status inserted = insert_individual_.Run(search, individual.id, individual.birth_generation,
                                               Blob{parents}, Blob{test_case});
      !inserted || connection_->Changes() > 0) {
    return inserted;
  }
  select_individual_.Bind(search, individual.id);
  Result<bool> row = select_individual_.Step();
  std::uint32_t stored_generation = 0;
  std::string stored_parents;
  std::string stored_case;
  if (row && *row) select_individual_.Read(stored_generation, stored_parents, stored_case);
  select_individual_.Reset();
  if (!row) return row.error();
  if (*row && stored_generation == individual.birth_generation && stored_parents == parents &&
      stored_case == test_case) {
    return Ok{};
  }
  return Conflict(fmt::format("individual {} of search {}", individual.id, search));
}

Status SqliteTables::Insert(const StoredRun& run) {
  Status inserted = insert_run_.Run(
      run.id, run.search, run.individual, run.evaluation, run.replicate, run.generation, run.seed,
      run.spec_hash, run.hash, run.verdict, std::bit_cast<std::uint64_t>(run.fitness), run.total_failure,
      run.failure_type, run.worker, run.attempt, Blob{run.spec}, Blob{run.result}, run.fitness);
  if (inserted) return inserted;
  return Error{inserted.error().kind, fmt::format("run {}: {}", run.id, inserted.error().message)};
}

Status SqliteTables::Insert(const SavedState& state) {
  if (Status inserted = insert_state_.Run(state.search, state.last_run, state.generation, Blob{state.state},
                                          Blob{state.results_digest}, ChecksumOf(state));
      !inserted || connection_->Changes() > 0) {
    return inserted;
  }
  Result<std::optional<SavedState>> stored = LoadState(state.search, state.last_run);
  if (!stored) return stored.error();
  if (stored->has_value() && ChecksumOf(**stored) == ChecksumOf(state)) return Ok{};
  return Conflict(fmt::format("the state of search {} after run {}", state.search, state.last_run));
}

Status SqliteTables::Insert(const StoredEvent& event) {
  return insert_event_.Run(event.unix_ms, event.kind, event.text);
}

Result<std::vector<StoredSearch>> SqliteTables::LoadSearches() {
  Result<SqliteStatement> query = connection_->Prepare(
      "SELECT id, name, algorithm, seed, EXISTS (SELECT 1 FROM finished WHERE search = searches.id) "
      "FROM searches ORDER BY id");
  if (!query) return query.error();
  std::vector<StoredSearch> searches;
  const Status read = query->ForEachRow([&]() -> Status {
    StoredSearch& search = searches.emplace_back();
    query->Read(search.id, search.name, search.algorithm, search.seed, search.finished);
    return Ok{};
  });
  if (!read) return read.error();
  return searches;
}

Result<std::vector<Individual>> SqliteTables::LoadIndividuals(SearchId search) {
  Result<SqliteStatement> query = connection_->Prepare(
      "SELECT id, birth_generation, parents, test_case FROM individuals WHERE search = ? ORDER BY id");
  if (!query) return query.error();
  query->Bind(search);
  std::vector<Individual> individuals;
  const Status read = query->ForEachRow([&]() -> Status {
    Individual& individual = individuals.emplace_back();
    std::string parents;
    std::string test_case;
    query->Read(individual.id, individual.birth_generation, parents, test_case);
    if (DecodeParents(parents, individual) && DecodeTestCase(test_case, individual.test_case)) return Ok{};
    return Error{ErrorKind::kCorrupt,
                 fmt::format("individual {} of search {} does not read back", individual.id, search)};
  });
  if (!read) return read.error();
  return individuals;
}

Result<std::optional<SavedState>> SqliteTables::LoadState(SearchId search, RunId until) {
  Result<SqliteStatement> query = connection_->Prepare(
      "SELECT search, last_run, generation, state, results_digest, checksum FROM states "
      "WHERE search = ? AND last_run <= ? ORDER BY last_run DESC LIMIT 1");
  if (!query) return query.error();
  query->Bind(search, until);
  Result<bool> row = query->Step();
  if (!row) return row.error();
  if (!*row) return std::optional<SavedState>();
  SavedState state;
  std::uint64_t checksum = 0;
  query->Read(state.search, state.last_run, state.generation, state.state, state.results_digest, checksum);
  if (checksum == ChecksumOf(state)) return std::optional(std::move(state));
  return Error{ErrorKind::kCorrupt,
               fmt::format("the state of search {} after run {} is damaged: its checksum differs",
                           state.search, state.last_run)};
}

Result<std::optional<SavedState>> SqliteTables::LoadNewestState(SearchId search) {
  return LoadState(search, std::numeric_limits<std::int64_t>::max());
}

Status SqliteTables::ForEachRun(SearchId search, RunId after,
                                const std::function<void(const StoredRun&)>& visit) {
  Result<SqliteStatement> query = connection_->Prepare(
      fmt::format("SELECT {} FROM runs WHERE search = ? AND id > ? ORDER BY id", kRunColumns));
  if (!query) return query.error();
  query->Bind(search, after);
  return query->ForEachRow([&]() -> Status {
    visit(ReadRun(*query));
    return Ok{};
  });
}

Result<std::optional<StoredRun>> SqliteTables::LoadRun(RunId run) {
  Result<SqliteStatement> query =
      connection_->Prepare(fmt::format("SELECT {} FROM runs WHERE id = ?", kRunColumns));
  if (!query) return query.error();
  query->Bind(run);
  Result<bool> row = query->Step();
  if (!row) return row.error();
  return *row ? std::optional(ReadRun(*query)) : std::nullopt;
}

Result<std::vector<StoredEvent>> SqliteTables::LoadEvents() {
  Result<SqliteStatement> query = connection_->Prepare("SELECT unix_ms, kind, text FROM events ORDER BY id");
  if (!query) return query.error();
  std::vector<StoredEvent> events;
  const Status read = query->ForEachRow([&]() -> Status {
    StoredEvent& event = events.emplace_back();
    query->Read(event.unix_ms, event.kind, event.text);
    return Ok{};
  });
  if (!read) return read.error();
  return events;
}

}  // namespace gauntlet::master
