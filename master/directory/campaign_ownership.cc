#include "master/directory/campaign_ownership.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/clock.h"
#include "base/system/process_identity.h"
#include "master/directory/owned_files.h"
#include "master/store/event_kinds.h"

namespace gauntlet {
namespace {

// A master waits so long for those who read. `show` of a large campaign takes its time, and `status` may come
// again and again.
constexpr std::chrono::seconds kReadersPatience{30};

// Those who read wait so long for a master that starts or ends.
constexpr std::chrono::seconds kMastersPatience{2};

LockOptions OptionsFor(const CampaignDirectory& directory) {
  LockOptions options;
  options.is_copy = [directory] { return IsUntakenCopy(directory); };
  return options;
}

Status CheckOwned(const CampaignDirectory& directory, OwnedFiles& files, CampaignLock& lock,
                  std::uint64_t epoch) {
  TRY(lock.Check());
  TRY(files.Check());
  Status newest = directory.CheckEpoch(epoch);
  if (newest || newest.error().kind != ErrorKind::kNotFound) return newest;
  // Somebody has deleted it. The lock file is the one that we hold and still names us, so no other master can
  // have counted since.
  TRY(lock.Heartbeat());
  return directory.RestoreEpoch(epoch);
}

// Counts the epoch, makes the database of a campaign that begins (`make_database`), and opens it: in this
// order, for from the epoch on no former master commits anything that we might not have read.
Result<CampaignOwnership> Own(CampaignDirectory directory, std::unique_ptr<CampaignLock> lock,
                              const std::function<Status()>& make_database = nullptr) {
  TRY(const std::uint64_t epoch, directory.StartEpoch());
  if (make_database) {
    TRY(make_database());
  }
  const auto files = std::make_shared<OwnedFiles>(directory);
  const auto check = [directory, files, lock = lock.get(), epoch] {
    return CheckOwned(directory, *files, *lock, epoch);
  };
  SqliteStore::Options options;
  options.guard = check;
  TRY(std::unique_ptr<SqliteStore> store, SqliteStore::Open(directory.database_path(), options));
  TRY(files->NoteOpened());
  TRY(CampaignOrigin origin, ConfirmOrigin(directory, store->meta().campaign_id));
  if (!origin.copied_from.empty()) {
    store->AddEvent({UnixMilliseconds(), event::kCopied,
                     fmt::format("this directory is a copy of campaign {}; it is campaign {} from now on",
                                 origin.copied_from, origin.campaign_id)});
  }
  return CampaignOwnership{std::move(directory), std::move(lock), epoch,
                           std::move(origin),    check,           std::move(store)};
}

Result<CampaignView> ViewBesideMaster(const CampaignDirectory& directory, Checked what) {
  TRY(std::unique_ptr<SqliteStore> store, SqliteStore::OpenBesideMaster(directory.database_path(), what));
  return CampaignView{directory, nullptr, std::move(store)};
}

// `in_use`: what there is to say without a snapshot.
Result<CampaignView> ViewSnapshot(const CampaignDirectory& directory, Checked what, const std::string& host,
                                  const Error& in_use) {
  const std::string path = directory.snapshot_path();
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) {
    return Error{in_use.kind, in_use.message +
                                  "; it has published nothing yet that could be read from this machine: "
                                  "try again in a moment"};
  }
  TRY(std::unique_ptr<SqliteStore> store, SqliteStore::OpenReadOnly(path, what));
  return CampaignView{directory, nullptr, std::move(store),
                      fmt::format("as of {:%H:%M}, on {}", fmt::localtime(info.st_mtim.tv_sec), host)};
}

}  // namespace

Result<CampaignOwnership> CreateCampaign(const std::string& dir, const CampaignTexts& texts,
                                         CampaignMeta meta, const std::function<Status(ResultStore&)>& fill) {
  TRY(CampaignDirectory directory, CampaignDirectory::Create(dir));
  TRY(std::unique_ptr<CampaignLock> lock, CampaignLock::Acquire(directory.lock_path(), directory.path()));
  // Another master may have made the campaign, and left it, between the two lines above.
  TRY(CampaignDirectory::Create(dir));

  meta.campaign_id = NewCampaignId();
  meta.created_unix_ms = UnixMilliseconds();
  for (const auto& [path, text] : {std::pair(directory.experiment_path(), texts.experiment),
                                   std::pair(directory.searches_path(), texts.searches),
                                   std::pair(directory.slurm_path(), texts.slurm)}) {
    if (text.empty()) continue;
    TRY(WriteFileAtomically(path, text, kReadableByAll));
  }
  if (texts.others) {
    TRY(texts.others(directory));
  }
  const auto fill_draft = [&](const std::string& draft) -> Status {
    if (!fill) return Ok{};
    TRY(const std::unique_ptr<SqliteStore> store, SqliteStore::Open(draft, {}));
    TRY(fill(*store));
    return store->Flush();
  };
  return Own(directory, std::move(lock),
             [&] { return CreateDatabase(directory.database_path(), meta, fill_draft); });
}

Result<CampaignOwnership> TakeCampaign(const std::string& dir, LivingMaster other,
                                       const std::function<bool()>& give_up) {
  TRY(CampaignDirectory directory, CampaignDirectory::Open(dir));
  TRY(directory.CheckTrusted());
  LockOptions options = OptionsFor(directory);
  options.patience = kReadersPatience;
  options.give_up = give_up;
  Result<std::unique_ptr<CampaignLock>> lock =
      CampaignLock::Acquire(directory.lock_path(), directory.path(), options);
  if (!lock && lock.error().kind == ErrorKind::kInUse && other == LivingMaster::kFence) {
    TRY(directory.StartEpoch());
    const auto deadline =
        std::chrono::steady_clock::now() + CampaignLock::kStaleAfter + std::chrono::seconds(10);
    while (!lock && lock.error().kind == ErrorKind::kInUse && !give_up() &&
           std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      lock = CampaignLock::Acquire(directory.lock_path(), directory.path(), options);
    }
  }
  if (!lock) return lock.error();
  // What a former master has left. Whoever asks from now on means this one.
  std::error_code ignored;
  std::filesystem::remove(directory.stop_path(), ignored);
  std::filesystem::remove(directory.status_path(), ignored);
  std::filesystem::remove(directory.snapshot_path(), ignored);
  return Own(std::move(directory), *std::move(lock));
}

Result<CampaignView> ViewCampaign(const std::string& dir, Checked what) {
  TRY(CampaignDirectory directory, CampaignDirectory::Open(dir));
  const auto deadline = std::chrono::steady_clock::now() + kMastersPatience;
  while (true) {
    Result<std::unique_ptr<CampaignLock>> lock =
        CampaignLock::AcquireForReading(directory.lock_path(), directory.path(), OptionsFor(directory));
    if (lock) {
      TRY(std::unique_ptr<SqliteStore> store, SqliteStore::OpenReadOnly(directory.database_path(), what));
      return CampaignView{std::move(directory), *std::move(lock), std::move(store)};
    }
    if (lock.error().kind != ErrorKind::kInUse) return lock.error();
    const std::optional<ProcessIdentity> owner = CampaignLock::OwnerOf(directory.lock_path());
    if (!owner) return lock.error();
    const bool here = LivenessOf(*owner, IdentifyThisProcess()) == Liveness::kAlive;
    Result<CampaignView> view =
        here ? ViewBesideMaster(directory, what) : ViewSnapshot(directory, what, owner->host, lock.error());
    // A master that has just ended, or taken its snapshot away, is looked for anew.
    const bool may_change =
        !view && (view.error().kind == ErrorKind::kInUse || view.error().kind == ErrorKind::kIo);
    if (!may_change || std::chrono::steady_clock::now() >= deadline) return view;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace gauntlet
