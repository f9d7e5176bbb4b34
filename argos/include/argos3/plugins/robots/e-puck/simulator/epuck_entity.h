// Another robot.
#pragma once

#error "Gauntlet's robots are foot-bots: leave controllers of the e-puck out"
