// ARGoS' window.
#pragma once

#error "Gauntlet shows no window: leave this source out; gauntlet replay and gauntlet report draw runs"
