// The plug-ins of a campaign: plugins/HASH.so, a copy of the library, from which its workers take it, and
// plugins/HASH.json, what it brings, from which whoever reads the campaign knows it.
// plugins/HASH.beginnings.json, where it brings the scenario, is what it has answered to how runs begin.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

// `folder` is plugins_path() of a campaign, or plugins/ of a study, and made when it is needed.

// Whether the plug-ins of these searches, all known, may be copied and run in our name. Error: as ReadPlugin.
Status CheckPlugins(const std::vector<SearchPlan>& plans);

// Copies the plug-ins of these searches into the folder; all are known (master/directory/plugins.h).
Status KeepPlugins(const std::string& folder, const std::vector<SearchPlan>& plans);

// Makes those of the folder known. Error: a description does not read back.
Status KnowPlugins(const std::string& folder);

// Whether each plug-in of these searches is still the one that the campaign was begun with. Error: the file
// is missing, or its hash is another one.
Status CheckPlugins(const std::string& folder, const std::vector<SearchPlan>& plans);

}  // namespace gauntlet
