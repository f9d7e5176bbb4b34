// A device of the eye-bot.
#pragma once

#error "Gauntlet's robots are foot-bots, which do not fly: leave controllers of the eye-bot out"
