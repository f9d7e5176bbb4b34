// origin.json: who this copy of a campaign is. A directory that was copied is another campaign from then on:
// with an id and keys of its own, so that workers and secrets of the one do not serve the other.
#pragma once

#include <string>

#include "base/result.h"
#include "master/directory/campaign_directory.h"

namespace gauntlet {

struct CampaignOrigin {
  std::string campaign_id;
  // The id that the directory had when it was copied; "" = it was not, this time.
  std::string copied_from = "";
};

// To be called under the campaign's lock. `born_as`: the id in the database. A campaign is known again by the
// inode numbers of its directory and its database, which a move within a file system and a mount on another
// host keep; whatever else changes them (a restored backup, a move to another file system) counts as a copy.
// Of a copy, access.json and master.key are removed; the database, which says what was simulated, stays as it
// is.
Result<CampaignOrigin> ConfirmOrigin(const CampaignDirectory& directory, const std::string& born_as);

// Whether the directory was copied and has had no master since, by the same signs. False when origin.json is
// missing or does not read back. Changes nothing.
bool IsUntakenCopy(const CampaignDirectory& directory);

}  // namespace gauntlet
