#include "master/store/sqlite_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <tuple>
#include <utility>

#include "base/canonical_encoder.h"
#include "base/hash.h"
#include "master/store/checksums.h"
#include "master/store/run_numbers.h"
#include "proto/run_text.h"
#include "sim/arena/genome.h"
#include "sim/run_result.h"

namespace gauntlet {
namespace {

constexpr std::string_view kRunColumns =
    "id, search, individual, evaluation, replicate, generation, seed, verdict, fitness_bits, "
    "total_failure, failure_type, message, hash, spec_hash, worker, attempt, record_hash, checksum";
// A run whose record is missing is damaged, not absent.
constexpr std::string_view kRuns = "runs";
constexpr std::string_view kWholeRuns = "runs LEFT JOIN records ON records.run = runs.id";

// Names in the table examples.
constexpr const char* kSpec = "spec";
constexpr const char* kResult = "result";

// What the search left out: how it was judged changes with every evaluation and follows from the runs.
std::string EncodeParents(const Individual& individual) {
  CanonicalEncoder encoder;
  encoder.Uint(individual.parents.size());
  for (const IndividualId parent : individual.parents) encoder.Uint(parent);
  return encoder.Take();
}

// What a stored test case has.
constexpr std::uint64_t kHasRobots = 1;
constexpr std::uint64_t kHasCenter = 2;

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
  // A bit each: stored cases around the origin keep their bytes.
  const bool elsewhere = test_case.center != sim::Vec2::Zero();
  encoder.Uint((test_case.robots ? kHasRobots : 0) | (elsewhere ? kHasCenter : 0));
  if (test_case.robots) encoder.Int(*test_case.robots);
  if (elsewhere) {
    encoder.Double(test_case.center.x());
    encoder.Double(test_case.center.y());
  }
  // At the end, and only where there are some: stored cases without keep their bytes.
  for (const sim::Pose& pose : test_case.start_poses) {
    encoder.Double(pose.position.x());
    encoder.Double(pose.position.y());
    encoder.Double(pose.heading);
  }
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
  const std::uint64_t has = decoder.Uint();
  if ((has & kHasRobots) != 0) test_case.robots = static_cast<int>(decoder.Int());
  if ((has & kHasCenter) != 0) {
    for (double* value : {&test_case.center.x(), &test_case.center.y()}) *value = decoder.Double();
  }
  while (decoder.ok() && !decoder.AtEnd()) {
    sim::Pose& pose = test_case.start_poses.emplace_back();
    for (double* value : {&pose.position.x(), &pose.position.y(), &pose.heading}) *value = decoder.Double();
  }
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

// As the column `verdict` has it.
int NumberOf(sim::Verdict verdict) {
  return static_cast<int>(verdict);
}

std::uint64_t ChecksumOf(const StoredRun& run, std::uint64_t record_hash) {
  return RowChecksum(run.id, run.search, run.individual, run.evaluation, run.replicate, run.generation,
                     run.seed, NumberOf(run.verdict), std::bit_cast<std::uint64_t>(run.fitness),
                     run.total_failure, run.failure_type, run.message, run.hash, run.spec_hash, run.worker,
                     run.attempt, record_hash);
}

// The ids of a search's runs stand together, behind the first number and up to the second: that is the index.
std::pair<RunId, RunId> RunsOf(SearchId search) {
  const RunId before_first = RunIdOf(search, 1) - 1;
  return {before_first, before_first + (1ULL << kSequenceBits) - 1};
}

Error DamagedDatabase(const std::string& what) {
  return {ErrorKind::kCorrupt, "the campaign's database was changed or is damaged: " + what};
}

Error Conflict(const std::string& what) {
  return {ErrorKind::kCorrupt, what + " is stored already, with other content"};
}

}  // namespace

Result<SqliteTables> SqliteTables::Open(SqliteConnection& connection) {
  TRY(TotalsTable totals, TotalsTable::Open(connection));
  SqliteTables tables(connection, std::move(totals));
  const std::pair<SqliteStatement*, std::string> statements[] = {
      {&tables.insert_search_, "INSERT INTO searches (id, name, algorithm, seed) VALUES (?, ?, ?, ?)"},
      {&tables.insert_individual_,
       "INSERT INTO individuals (search, id, birth_generation, parents, test_case, checksum) "
       "VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
      {&tables.insert_run_, fmt::format("INSERT INTO runs ({}, fitness) "
                                        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                                        kRunColumns)},
      {&tables.insert_record_, "INSERT INTO records (run, spec, result) VALUES (?, ?, ?)"},
      {&tables.insert_example_, "INSERT INTO examples (kind, bytes, checksum) VALUES (?, ?, ?)"},
      {&tables.insert_state_,
       "INSERT INTO states (search, last_run, generation, state, results_digest, checksum) "
       "VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
      {&tables.insert_event_, "INSERT INTO events (unix_ms, kind, text) VALUES (?, ?, ?)"},
      {&tables.insert_finished_,
       "INSERT INTO finished (search, last_run) VALUES (?, ?) ON CONFLICT DO NOTHING"},
      {&tables.select_individual_,
       "SELECT birth_generation, parents, test_case FROM individuals WHERE search = ? AND id = ?"},
  };
  for (const auto& [statement, sql] : statements) {
    TRY(SqliteStatement prepared, connection.Prepare(sql));
    *statement = std::move(prepared);
  }
  TRY(tables.LoadExamples());
  return tables;
}

Status SqliteTables::LoadExamples() {
  TRY(SqliteStatement query, connection_->Prepare("SELECT kind, bytes, checksum FROM examples"));
  return query.ForEachRow([&]() -> Status {
    std::string kind;
    std::string bytes;
    std::uint64_t checksum = 0;
    query.Read(kind, bytes, checksum);
    if (checksum != RowChecksum(kind, bytes))
      return Error{ErrorKind::kCorrupt,
                   fmt::format("the example of a {} was changed: its checksum differs", kind)};
    if (kind == kSpec) specs_.Learn(bytes);
    if (kind == kResult) results_.Learn(bytes);
    return Ok{};
  });
}

Status SqliteTables::Learn(Packing& packing, const char* kind, std::string_view example) {
  packing.Learn(example);
  ++totals_.Of(TotalsTable::kNoSearch).examples;
  return insert_example_.Run(kind, Blob{example}, RowChecksum(kind, example));
}

void SqliteTables::Rollback() {
  // An error here means that SQLite has rolled back by itself.
  (void)connection_->Execute("ROLLBACK");
}

Status SqliteTables::Insert(const StoredSearch& search) {
  TRY(insert_search_.Run(search.id, search.name, search.algorithm, search.seed));
  totals_.Of(search.id).search = search.id;
  return search.finished_with > 0 ? Insert(Finished{search.id, search.finished_with}) : Ok{};
}

Status SqliteTables::Insert(const Finished& finished) {
  const Status inserted = insert_finished_.Run(finished.search, finished.last_run);
  if (inserted && connection_->Changes() > 0) ++totals_.Of(finished.search).finished;
  return inserted;
}

Status SqliteTables::Insert(const Newborns& newborns) {
  for (const Individual& individual : newborns.individuals) {
    TRY(Insert(newborns.search, individual));
  }
  return Ok{};
}

Status SqliteTables::Insert(SearchId search, const Individual& individual) {
  const std::string parents = EncodeParents(individual);
  const std::string test_case = EncodeTestCase(individual.test_case);
  const std::string packed = specs_.Pack(test_case);
  TRY(insert_individual_.Run(
      search, individual.id, individual.birth_generation, Blob{parents}, Blob{packed},
      RowChecksum(search, individual.id, individual.birth_generation, parents, test_case)));
  if (connection_->Changes() > 0) {
    ++totals_.Of(search).individuals;
    return Ok{};
  }
  select_individual_.Bind(search, individual.id);
  Result<bool> row = select_individual_.Step();
  std::uint32_t stored_generation = 0;
  std::string stored_parents;
  std::string stored_case;
  if (row && *row) select_individual_.Read(stored_generation, stored_parents, stored_case);
  select_individual_.Reset();
  if (!row) return row.error();
  if (*row && stored_generation == individual.birth_generation && stored_parents == parents) {
    const Result<std::string> unpacked = specs_.Unpack(stored_case);
    if (unpacked && *unpacked == test_case) return Ok{};
  }
  return Conflict(fmt::format("individual {} of search {}", individual.id, search));
}

Status SqliteTables::Insert(const StoredRun& run) {
  Status inserted = Ok{};
  if (!specs_.learned()) inserted = Learn(specs_, kSpec, run.spec);
  if (inserted && run.completed() && !results_.learned()) inserted = Learn(results_, kResult, run.result);
  const std::string spec = specs_.Pack(run.spec);
  const std::string result = results_.Pack(run.result);
  const std::uint64_t record_hash = RowChecksum(spec, result);
  if (inserted) {
    inserted =
        insert_run_.Run(run.id, run.search, run.individual, run.evaluation, run.replicate, run.generation,
                        run.seed, NumberOf(run.verdict), std::bit_cast<std::uint64_t>(run.fitness),
                        run.total_failure, run.failure_type, run.message, run.hash, run.spec_hash, run.worker,
                        run.attempt, record_hash, ChecksumOf(run, record_hash), run.fitness);
  }
  if (inserted) inserted = insert_record_.Run(run.id, Blob{spec}, Blob{result});
  if (!inserted)
    return Error{inserted.error().kind,
                 fmt::format("run {}: {}", proto::RunText(run.id), inserted.error().message)};
  totals_.Of(run.search).Count(run);
  return Ok{};
}

Status SqliteTables::Insert(const SavedState& state) {
  const std::string packed = specs_.Pack(state.state);  // genomes, too
  TRY(insert_state_.Run(state.search, state.last_run, state.generation, Blob{packed},
                        Blob{state.results_digest}, ChecksumOf(state)));
  if (connection_->Changes() > 0) {
    ++totals_.Of(state.search).states;
    return Ok{};
  }
  TRY(std::optional<SavedState> stored, LoadState(state.search, state.last_run));
  if (stored.has_value() && ChecksumOf(*stored) == ChecksumOf(state)) return Ok{};
  return Conflict(
      fmt::format("the state of search {} after run {}", state.search, proto::RunText(state.last_run)));
}

Status SqliteTables::Insert(const StoredEvent& event) {
  const Status inserted = insert_event_.Run(event.unix_ms, event.kind, event.text);
  if (inserted) ++totals_.Of(TotalsTable::kNoSearch).events;
  return inserted;
}

Result<std::vector<StoredSearch>> SqliteTables::LoadSearches() {
  TRY(SqliteStatement query,
      connection_->Prepare(
          "SELECT id, name, algorithm, seed, coalesce((SELECT max(last_run) FROM finished WHERE search = "
          "searches.id), 0) FROM searches ORDER BY id"));
  TRY(SqliteStatement last,
      connection_->Prepare("SELECT coalesce(max(id), 0) FROM runs WHERE id > ? AND id <= ?"));
  std::vector<StoredSearch> searches;
  TRY(query.ForEachRow([&]() -> Status {
    StoredSearch& search = searches.emplace_back();
    query.Read(search.id, search.name, search.algorithm, search.seed, search.finished_with);
    const auto [before, end] = RunsOf(search.id);
    last.Bind(before, end);
    TRY(const bool row, last.Step());
    if (row) last.Read(search.last_run);
    last.Reset();
    return Ok{};
  }));
  return searches;
}

Result<std::vector<SearchTotals>> SqliteTables::LoadTotals() {
  std::vector<SearchTotals> all;
  for (const auto& [search, totals] : totals_.all()) {
    if (search != TotalsTable::kNoSearch) all.push_back(totals);
  }
  return all;
}

Result<std::vector<Individual>> SqliteTables::LoadIndividuals(SearchId search, IndividualId after) {
  TRY(SqliteStatement query, connection_->Prepare("SELECT id, birth_generation, parents, test_case, checksum "
                                                  "FROM individuals WHERE search = ? AND id > ? ORDER BY "
                                                  "id"));
  query.Bind(search, after);
  std::vector<Individual> individuals;
  if (const auto totals = totals_.all().find(search); after == 0 && totals != totals_.all().end())
    individuals.reserve(totals->second.individuals);
  std::string parents;
  std::string test_case;
  std::uint64_t checksum = 0;
  TRY(query.ForEachRow([&]() -> Status {
    Individual& individual = individuals.emplace_back();
    query.Read(individual.id, individual.birth_generation, parents, test_case, checksum);
    Result<std::string> unpacked = specs_.Unpack(test_case);
    if (unpacked) test_case = *std::move(unpacked);
    if (checksum != RowChecksum(search, individual.id, individual.birth_generation, parents, test_case)) {
      return DamagedDatabase(
          fmt::format("individual {} of search {} was changed: its checksum differs", individual.id, search));
    }
    if (DecodeParents(parents, individual) && DecodeTestCase(test_case, individual.test_case)) return Ok{};
    return Error{ErrorKind::kCorrupt,
                 fmt::format("individual {} of search {} does not read back", individual.id, search)};
  }));
  return individuals;
}

Result<std::optional<SavedState>> SqliteTables::LoadState(SearchId search, RunId until) {
  TRY(SqliteStatement query,
      connection_->Prepare("SELECT search, last_run, generation, state, results_digest, checksum FROM states "
                           "WHERE search = ? AND last_run <= ? ORDER BY last_run DESC LIMIT 1"));
  query.Bind(search, until);
  TRY(bool row, query.Step());
  if (!row) return std::optional<SavedState>();
  SavedState state;
  std::uint64_t checksum = 0;
  query.Read(state.search, state.last_run, state.generation, state.state, state.results_digest, checksum);
  if (Result<std::string> bytes = specs_.Unpack(state.state)) {
    state.state = *std::move(bytes);
    if (checksum == ChecksumOf(state)) return std::optional(std::move(state));
  }
  return Error{ErrorKind::kCorrupt,
               fmt::format("the state of search {} after run {} is damaged: its checksum differs",
                           state.search, state.last_run)};
}

Result<std::optional<SavedState>> SqliteTables::LoadNewestState(SearchId search) {
  return LoadState(search, std::numeric_limits<std::int64_t>::max());
}

Result<StoredRun> SqliteTables::ReadRun(const SqliteStatement& row, bool whole) {
  StoredRun run;
  int verdict = 0;
  std::uint64_t fitness_bits = 0;
  std::uint64_t record_hash = 0;
  std::uint64_t checksum = 0;
  std::string spec;
  std::string result;
  const auto read = [&](auto&... more) {
    row.Read(run.id, run.search, run.individual, run.evaluation, run.replicate, run.generation, run.seed,
             verdict, fitness_bits, run.total_failure, run.failure_type, run.message, run.hash, run.spec_hash,
             run.worker, run.attempt, record_hash, checksum, more...);
  };
  if (whole) {
    read(spec, result);
  } else {
    read();
  }
  run.verdict = static_cast<sim::Verdict>(verdict);
  run.fitness = std::bit_cast<double>(fitness_bits);
  if (checksum != ChecksumOf(run, record_hash))
    return DamagedDatabase(
        fmt::format("the row of run {} was changed: its checksum differs", proto::RunText(run.id)));
  if (!whole) return run;
  if (record_hash != RowChecksum(spec, result))
    return DamagedDatabase(fmt::format("the spec or the result of run {} was changed: their checksum differs",
                                       proto::RunText(run.id)));
  for (const auto& [packing, packed, into] :
       {std::tuple(&specs_, &spec, &run.spec), std::tuple(&results_, &result, &run.result)}) {
    Result<std::string> bytes = packing->Unpack(*packed);
    if (!bytes)
      return DamagedDatabase(fmt::format("run {}: {}", proto::RunText(run.id), bytes.error().message));
    *into = *std::move(bytes);
  }
  return run;
}

Status SqliteTables::ForEach(SearchId search, RunId after, bool whole, const RunVisitor& visit) {
  const auto [before_first, last] = RunsOf(search);
  TRY(SqliteStatement query, connection_->Prepare(fmt::format(
                                 "SELECT {}{} FROM {} WHERE id > ? AND id <= ? ORDER BY id", kRunColumns,
                                 whole ? ", records.spec, records.result" : "", whole ? kWholeRuns : kRuns)));
  query.Bind(std::max(after, before_first), last);
  return query.ForEachRow([&]() -> Status {
    TRY(const StoredRun run, ReadRun(query, whole));
    return visit(run);
  });
}

Status SqliteTables::ForEachRun(SearchId search, RunId after, const RunVisitor& visit) {
  return ForEach(search, after, /*whole=*/true, visit);
}

Status SqliteTables::ForEachRow(SearchId search, RunId after, const RunVisitor& visit) {
  return ForEach(search, after, /*whole=*/false, visit);
}

Result<std::optional<StoredRun>> SqliteTables::LoadRun(RunId run) {
  TRY(SqliteStatement query,
      connection_->Prepare(fmt::format("SELECT {}, records.spec, records.result FROM {} WHERE id = ?",
                                       kRunColumns, kWholeRuns)));
  query.Bind(run);
  TRY(bool row, query.Step());
  if (!row) return std::optional<StoredRun>();
  TRY(StoredRun read, ReadRun(query, /*whole=*/true));
  return std::optional(std::move(read));
}

Result<std::vector<StoredEvent>> SqliteTables::LoadEvents() {
  TRY(SqliteStatement query, connection_->Prepare("SELECT unix_ms, kind, text FROM events ORDER BY id"));
  std::vector<StoredEvent> events;
  TRY(query.ForEachRow([&]() -> Status {
    StoredEvent& event = events.emplace_back();
    query.Read(event.unix_ms, event.kind, event.text);
    return Ok{};
  }));
  return events;
}

}  // namespace gauntlet
