#include "master/directory/campaign_ownership.h"

#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/clock.h"

namespace gauntlet::master {
namespace {

// A master waits so long for those who read. `show` of a large campaign takes its time, and `status` may come
// again and again.
constexpr std::chrono::seconds kReadersPatience{30};

LockOptions OptionsFor(const CampaignDirectory& directory) {
  LockOptions options;
  options.is_copy = [directory] { return IsUntakenCopy(directory); };
  return options;
}

// Counts the epoch, makes the database of a campaign that begins (`born` says what it is), and opens it: in
// this order, for from the epoch on no former master commits anything that we might not have read.
Result<CampaignOwnership> Own(CampaignDirectory directory, std::unique_ptr<CampaignLock> lock,
                              const CampaignMeta* born) {
  const Result<std::uint64_t> epoch = directory.StartEpoch();
  if (!epoch) return epoch.error();
  if (born != nullptr) {
    if (Status made = CreateDatabase(directory.database_path(), *born); !made) return made.error();
  }
  SqliteStore::Options options;
  options.guard = [directory, lock = lock.get(), epoch = *epoch]() -> Status {
    if (Status held = lock->Check(); !held) return held;
    return directory.CheckEpoch(epoch);
  };
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(directory.database_path(), options);
  if (!store) return store.error();
  Result<CampaignOrigin> origin = ConfirmOrigin(directory, (*store)->meta().campaign_id);
  if (!origin) return origin.error();
  return CampaignOwnership{std::move(directory), std::move(lock), *epoch, *std::move(origin),
                           *std::move(store)};
}

}  // namespace

Result<CampaignOwnership> CreateCampaign(const std::string& dir, const CampaignTexts& texts,
                                         CampaignMeta meta) {
  Result<CampaignDirectory> directory = CampaignDirectory::Create(dir);
  if (!directory) return directory.error();
  Result<std::unique_ptr<CampaignLock>> lock =
      CampaignLock::Acquire(directory->lock_path(), directory->path());
  if (!lock) return lock.error();
  // Another master may have made the campaign, and left it, between the two lines above.
  if (Result<CampaignDirectory> unchanged = CampaignDirectory::Create(dir); !unchanged)
    return unchanged.error();

  meta.campaign_id = NewCampaignId();
  meta.created_unix_ms = UnixMilliseconds();
  for (const auto& [path, text] : {std::pair(directory->experiment_path(), texts.experiment),
                                   std::pair(directory->searches_path(), texts.searches),
                                   std::pair(directory->slurm_path(), texts.slurm)}) {
    if (text.empty()) continue;
    if (Status written = WriteFileAtomically(path, text, kReadableByAll); !written) return written.error();
  }
  return Own(*std::move(directory), *std::move(lock), &meta);
}

Result<CampaignOwnership> TakeCampaign(const std::string& dir, LivingMaster other) {
  Result<CampaignDirectory> directory = CampaignDirectory::Open(dir);
  if (!directory) return directory.error();
  LockOptions options = OptionsFor(*directory);
  options.patience = kReadersPatience;
  Result<std::unique_ptr<CampaignLock>> lock =
      CampaignLock::Acquire(directory->lock_path(), directory->path(), options);
  if (!lock && lock.error().kind == ErrorKind::kInUse && other == LivingMaster::kFence) {
    if (Result<std::uint64_t> fence = directory->StartEpoch(); !fence) return fence.error();
    const auto deadline =
        std::chrono::steady_clock::now() + CampaignLock::kStaleAfter + std::chrono::seconds(10);
    while (!lock && lock.error().kind == ErrorKind::kInUse && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      lock = CampaignLock::Acquire(directory->lock_path(), directory->path(), options);
    }
  }
  if (!lock) return lock.error();
  // What a former master has left. Whoever asks from now on means this one.
  std::error_code ignored;
  std::filesystem::remove(directory->stop_path(), ignored);
  std::filesystem::remove(directory->status_path(), ignored);
  return Own(*std::move(directory), *std::move(lock), nullptr);
}

Result<CampaignView> ViewCampaign(const std::string& dir) {
  Result<CampaignDirectory> directory = CampaignDirectory::Open(dir);
  if (!directory) return directory.error();
  Result<std::unique_ptr<CampaignLock>> lock =
      CampaignLock::AcquireForReading(directory->lock_path(), directory->path(), OptionsFor(*directory));
  if (!lock) return lock.error();
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(directory->database_path());
  if (!store) return store.error();
  return CampaignView{*std::move(directory), *std::move(lock), *std::move(store)};
}

}  // namespace gauntlet::master
