// Proximity sensors of any robot.
#pragma once

#error \
    "Gauntlet's foot-bot has its own proximity sensors: use CCI_FootBotProximitySensor (footbot_proximity); controllers of other robots do not run in Gauntlet"
