// How an archive search is saved and restored.
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "search/archive/archive_search.h"
#include "sim/arena/genome.h"

namespace gauntlet {
namespace {

// Nothing: the number is no emitter's.
std::optional<Emitter> RestoreEmitter(CanonicalDecoder& decoder) {
  const std::uint64_t number = decoder.Uint();
  if (number >= kEmitters) return std::nullopt;
  return static_cast<Emitter>(number);
}

}  // namespace

void ArchiveSearch::SaveFinding(const Finding& finding, CanonicalEncoder& encoder) {
  SaveIndividuals({finding.individual}, encoder);
  encoder.Int(finding.tally.failures);
  encoder.Int(finding.tally.passes);
  encoder.Int(finding.tally.errors);
  encoder.Bool(finding.mirrored);
  encoder.Uint(finding.failures.size());
  for (const Descriptor& failure : finding.failures) {
    for (const double value : failure) encoder.Double(value);
  }
}

Result<Finding> ArchiveSearch::RestoreFinding(CanonicalDecoder& decoder) const {
  TRY(auto individual, RestoreIndividuals(1, next_id_, decoder));
  Finding finding;
  finding.individual = std::move(individual.front());
  finding.tally.failures = static_cast<int>(decoder.Int());
  finding.tally.passes = static_cast<int>(decoder.Int());
  finding.tally.errors = static_cast<int>(decoder.Int());
  finding.mirrored = decoder.Bool();
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    Descriptor& failure = finding.failures.emplace_back(archive_.grid().axes().size());
    for (double& value : failure) value = decoder.Double();
  }
  return finding;
}

void ArchiveSearch::SaveSlot(const Slot& slot, CanonicalEncoder& encoder) {
  encoder.Uint(static_cast<std::uint64_t>(slot.emitter));
  encoder.Uint(slot.cell);
  encoder.Uint(slot.parent);
  SaveFinding(slot.finding, encoder);
  encoder.Bool(slot.root.has_value());
  if (slot.root) SaveFinding(*slot.root, encoder);
  encoder.Uint(slot.plan.size());
  for (const Step& step : slot.plan) {
    encoder.Uint(static_cast<std::uint64_t>(step.emitter));
    sim::EncodeGenome(step.obstacles, encoder);
  }
}

Status ArchiveSearch::RestoreSlot(CanonicalDecoder& decoder, Slot& slot) const {
  slot.plan.clear();
  slot.root.reset();
  const std::optional<Emitter> emitter = RestoreEmitter(decoder);
  if (!emitter) return Damaged("a layout comes from nowhere");
  slot.emitter = *emitter;
  slot.cell = decoder.Uint();
  slot.parent = decoder.Uint();
  TRY(slot.finding, RestoreFinding(decoder));
  if (decoder.Bool()) {
    TRY(slot.root, RestoreFinding(decoder));
  }
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    const std::optional<Emitter> planned = RestoreEmitter(decoder);
    if (!planned) return Damaged("a planned layout comes from nowhere");
    slot.plan.push_back({*planned, sim::DecodeGenome(decoder)});
  }
  return Ok{};
}

void ArchiveSearch::SaveRest(CanonicalEncoder& encoder) const {
  encoder.Uint(next_id_);
  for (const EmitterAccount& account : accounts_) {
    encoder.Uint(account.runs);
    encoder.Uint(account.layouts);
    encoder.Uint(account.elites);
  }
  encoder.Uint(archive_.shelves().size());
  for (const auto& [cell, shelf] : archive_.shelves()) {
    encoder.Uint(cell);
    encoder.Uint(shelf.size());
    for (const Finding& finding : shelf) SaveFinding(finding, encoder);
  }
  for (const Slot& slot : slots_) SaveSlot(slot, encoder);
  for (const std::size_t slot : waiting_) encoder.Uint(slot);
  prior_.Save(encoder);
}

Status ArchiveSearch::RestoreRest(CanonicalDecoder& decoder, const History& /*history*/) {
  next_id_ = decoder.Uint();
  for (EmitterAccount& account : accounts_) {
    account.runs = decoder.Uint();
    account.layouts = decoder.Uint();
    account.elites = decoder.Uint();
  }
  FailureArchive::Shelves shelves;
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    std::vector<Finding>& shelf = shelves[decoder.Uint()];
    for (std::uint64_t findings = decoder.Uint(); findings > 0 && decoder.ok(); --findings) {
      TRY(auto finding, RestoreFinding(decoder));
      shelf.push_back(std::move(finding));
    }
    if (shelf.empty()) return Damaged("a cell of its archive is empty");
  }
  if (!shelves.empty() && shelves.rbegin()->first >= archive_.grid().cells()) {
    return Damaged("its archive has a cell that is none");
  }
  archive_.Restore(std::move(shelves));
  for (Slot& slot : slots_) {
    TRY(RestoreSlot(decoder, slot));
  }
  for (std::size_t& slot : waiting_) {
    slot = decoder.Uint();
    if (slot >= slots_.size()) return Damaged(fmt::format("slot {} waits", slot));
  }
  if (!decoder.AtEnd()) prior_.Restore(decoder);  // states of earlier versions end here
  if (std::set<std::size_t>(waiting_.begin(), waiting_.end()).size() != slots_.size()) {
    return Damaged("a slot does not wait");
  }
  asked_ = 0;
  UpdatePopulation();
  return Ok{};
}

}  // namespace gauntlet
