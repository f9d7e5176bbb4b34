// Light sensors of any robot.
#pragma once

#error \
    "Gauntlet's foot-bot has its own light sensors: use CCI_FootBotLightSensor (footbot_light); controllers of other robots do not run in Gauntlet"
