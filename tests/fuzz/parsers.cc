#include "tests/fuzz/parsers.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "controllers/generic/definition.h"
#include "controllers/requirements/requirements.h"
#include "controllers/rows/row_checks.h"
#include "master/store/packing.h"
#include "proto/access_file.h"
#include "proto/case_json.h"
#include "proto/json_text.h"
#include "proto/message_codec.h"
#include "proto/run_beginning.h"
#include "proto/run_codec.h"
#include "search/cases/argos_controllers.h"
#include "search/cases/argos_template.h"
#include "search/cases/case_file.h"
#include "search/cases/corpus_file.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "slurm/cluster.h"
#include "study/streams/evaluation_line.h"
#include "study/study.h"

namespace gauntlet::fuzz {
namespace {

constexpr std::size_t kMostMessage = 100'000;

// Errors are for people: one line, not empty, no longer than a screen.
template <typename T>
void ExpectAGoodError(const Result<T>& result) {
  const std::string& message = result.error().message;
  GAUNTLET_CHECK(!message.empty() && message.size() < kMostMessage && message.find('\n') == std::string::npos,
                 "a bad error message: '" + message + "'");
}

// A frame may come from either side; what it carries is decoded as the next step would.
void ReadWire(std::string_view bytes) {
  const Result<proto::WorkerMessage> from_worker = proto::DecodeWorkerMessage(bytes);
  if (!from_worker) {
    ExpectAGoodError(from_worker);
  } else if (const auto* result = std::get_if<proto::LeaseResult>(&*from_worker)) {
    const Result<sim::RunResult> decoded = proto::DecodeRunResult(result->result);
    if (!decoded) ExpectAGoodError(decoded);
  }
  const Result<proto::MasterMessage> from_master = proto::DecodeMasterMessage(bytes);
  if (!from_master) {
    ExpectAGoodError(from_master);
  } else if (const auto* lease = std::get_if<proto::Lease>(&*from_master)) {
    const Result<sim::RunSpec> decoded = proto::DecodeRunSpec(lease->spec);
    if (!decoded) ExpectAGoodError(decoded);
  }
}

// Stored specs and results: what was read is written and read again, and is the same.
void ReadRun(std::string_view bytes) {
  if (const Result<sim::RunSpec> spec = proto::DecodeRunSpec(bytes); spec) {
    const std::string encoded = proto::EncodeRunSpec(*spec);
    const Result<sim::RunSpec> again = proto::DecodeRunSpec(encoded);
    GAUNTLET_CHECK(again.ok() && proto::EncodeRunSpec(*again) == encoded, "a spec does not survive");
  }
  if (const Result<sim::RunResult> result = proto::DecodeRunResult(bytes); result) {
    const Result<sim::RunResult> again = proto::DecodeRunResult(proto::EncodeRunResult(*result));
    GAUNTLET_CHECK(again.ok() && again->hash == result->hash, "a result does not survive");
    const Result<sim::RunResult> stored = proto::DecodeStoredResult(proto::EncodeWithoutWays(*result));
    GAUNTLET_CHECK(stored.ok() && stored->hash == result->hash, "a result without ways does not survive");
  }
  (void)proto::DecodeStoredResult(bytes);
}

// The one form of a definition that is right.
std::string Rewritten(std::string_view definition) {
  const auto entries = controllers::generic::EntriesOf(definition);
  controllers::generic::DefinitionReader reader;
  for (const auto& [path, value] : *entries)
    GAUNTLET_CHECK(reader.Set(path, value).ok(), "an entry that was taken is refused");
  return reader.Text().value();
}

// A definition comes with the spec of a run.
void ReadDefinition(std::string_view bytes) {
  const Result<controllers::generic::Definition> read = controllers::generic::ParseDefinition(bytes);
  if (!read) return ExpectAGoodError(read);
  const std::string written = Rewritten(bytes);
  GAUNTLET_CHECK(Rewritten(written) == written, "a definition does not survive:\n" + written);
}

void ReadCaseJson(std::string_view bytes) {
  const Result<sim::TestCase> read = proto::ParseCaseJson(std::string(bytes), "case.json");
  if (!read) return ExpectAGoodError(read);
  const std::string written = proto::WriteCaseJson(*read);
  const Result<sim::TestCase> again = proto::ParseCaseJson(written, "again.json");
  GAUNTLET_CHECK(again.ok() && proto::WriteCaseJson(*again) == written,
                 "a case does not survive:\n" + written);
}

void ReadCorpusCase(std::string_view bytes) {
  const Result<CorpusCase> read = ParseCorpusCase(std::string(bytes), "case.json");
  if (!read) return ExpectAGoodError(read);
  const std::string written = WriteCorpusCase(*read);
  const Result<CorpusCase> again = ParseCorpusCase(written, "again.json");
  GAUNTLET_CHECK(again.ok() && WriteCorpusCase(*again) == written,
                 "a case of a corpus does not survive:\n" + written);
}

void ReadArgos(std::string_view bytes) {
  const auto controllers = ReadArgosControllers(std::string(bytes), "case.argos", "");
  if (!controllers) ExpectAGoodError(controllers);
  const Result<ArgosTemplate> project = MakeArgosTemplate(std::string(bytes), "project.argos", {});
  if (!project) {
    ExpectAGoodError(project);
  } else {
    (void)WithWorld(project->text, "world.xml");
    (void)WithoutRecorder(project->text);
  }
  const Result<LoadedCase> read = ParseArgos(std::string(bytes), "case.argos");
  if (!read) return ExpectAGoodError(read);
  for (const sim::ObstacleGene& obstacle : read->test_case.obstacles) {
    GAUNTLET_CHECK(std::isfinite(obstacle.x) && std::isfinite(obstacle.y) && std::isfinite(obstacle.length) &&
                       std::isfinite(obstacle.width) && std::isfinite(obstacle.orientation_deg),
                   "an obstacle that is no number");
  }
  for (const sim::Pose& pose : read->test_case.start_poses) {
    GAUNTLET_CHECK(pose.position.allFinite() && std::abs(pose.heading) <= sim::kPi, "a pose that is none");
  }
  GAUNTLET_CHECK(read->notice.find('\n') == std::string::npos, "a notice of several lines");
}

void ReadExperiment(std::string_view bytes) {
  const Result<Experiment> read = ParseExperiment(bytes, "experiment.toml", {}, BuiltInCatalogue());
  if (!read) return ExpectAGoodError(read);
  const std::string written = WriteExperiment(*read, {}, BuiltInCatalogue());
  const Result<Experiment> again = ParseExperiment(written, "again.toml", {}, BuiltInCatalogue());
  GAUNTLET_CHECK(again.ok() && WriteExperiment(*again, {}, BuiltInCatalogue()) == written,
                 "an experiment does not survive:\n" + written);
}

void ReadAccessFile(std::string_view bytes) {
  const Result<proto::Access> read = proto::ParseAccess(std::string(bytes), "access.json");
  if (!read) return ExpectAGoodError(read);
  GAUNTLET_CHECK(!read->endpoints.empty(), "an access.json without an endpoint");
}

// What a library says of itself comes with a campaign.
Result<controllers::PluginRows> RowsOf(std::string_view bytes) {
  TRY(const nlohmann::json json, ParseJson(bytes, "plugin.json"));
  return controllers::ReadRows(json, "plugin.json");
}

void ReadPlugin(std::string_view bytes) {
  const Result<controllers::PluginRows> read = RowsOf(bytes);
  if (!read) return ExpectAGoodError(read);
  const std::string written = controllers::WriteRows(*read);
  const Result<controllers::PluginRows> again = RowsOf(written);
  GAUNTLET_CHECK(again.ok() && controllers::WriteRows(*again) == written,
                 "a plug-in's description does not survive:\n" + written);
}

void ReadBeginning(std::string_view bytes) {
  const Result<sim::RunBeginning> read = proto::ReadBeginning(bytes, "beginning.json");
  if (!read) return ExpectAGoodError(read);
  const std::string written = proto::WriteBeginning(*read);
  const Result<sim::RunBeginning> again = proto::ReadBeginning(written, "again.json");
  GAUNTLET_CHECK(again.ok() && proto::WriteBeginning(*again) == written,
                 "the beginning of a run does not survive:\n" + written);
}

// A line that was taken is stored, and read back by the next master.
void ReadLine(std::string_view bytes) {
  static EvaluationLineReader reader(
      LoadExperiment("flocking", {"search.algorithm=stream"}, BuiltInCatalogue()).value());
  LineError wrong;
  const std::optional<EvaluationLine> line = reader.Read(bytes, wrong);
  if (!line) return ExpectAGoodError(Result<int>(InvalidInput(wrong.message)));
  const auto again = reader.Restore({.individual = 1, .content = line->content}, line->asked.test_case);
  GAUNTLET_CHECK(again.ok() && again->seed == line->asked.seed && again->replicates == line->asked.replicates,
                 "a line does not survive: " + line->content);
}

// Specs and results lie packed in the database of a campaign, which may be another user's.
void ReadPacked(std::string_view bytes) {
  Packing packing;
  packing.Learn("what specs have in common, parameter after parameter, obstacle after obstacle");
  const Result<std::string> unpacked = packing.Unpack(bytes);
  if (!unpacked) return ExpectAGoodError(unpacked);
  for (int times = 0; times < 2; ++times) {  // compressed, then as what was packed before
    const Result<std::string> again = packing.Unpack(packing.Pack(*unpacked));
    GAUNTLET_CHECK(again.ok() && *again == *unpacked, "packed bytes do not survive");
  }
}

// The requirements of an experiment come with the spec of a run.
void ReadRequirements(std::string_view bytes) {
  const auto& metrics = controllers::FindScenario("flocking")->metrics;
  const auto read = controllers::requirements::Requirements::Parse(bytes, metrics);
  if (!read) return ExpectAGoodError(read);
  if (const Status complete = read->Check(); !complete) return ExpectAGoodError(complete);
  GAUNTLET_CHECK(!read->Metrics().empty(), "requirements of which a run reports nothing");
}

void ReadCluster(std::string_view bytes) {
  if (const auto read = slurm::ReadCluster(bytes, "cluster.toml"); !read) ExpectAGoodError(read);
}

void ReadAStudy(std::string_view bytes) {
  if (const auto read = ReadStudy({{"study.toml", std::string(bytes)}}, "study.toml"); !read)
    ExpectAGoodError(read);
}

}  // namespace

std::span<const Parser> Parsers() {
  static const std::array<Parser, 15> parsers{{{"wire", ReadWire},
                                               {"run", ReadRun},
                                               {"case_json", ReadCaseJson},
                                               {"corpus_case", ReadCorpusCase},
                                               {"argos", ReadArgos},
                                               {"experiment", ReadExperiment},
                                               {"definition", ReadDefinition},
                                               {"access", ReadAccessFile},
                                               {"plugin", ReadPlugin},
                                               {"beginning", ReadBeginning},
                                               {"line", ReadLine},
                                               {"packed", ReadPacked},
                                               {"requirements", ReadRequirements},
                                               {"cluster", ReadCluster},
                                               {"study", ReadAStudy}}};
  return parsers;
}

}  // namespace gauntlet::fuzz
