// A device of the e-puck.
#pragma once

#error "Gauntlet's robots are foot-bots: leave controllers of the e-puck out"
