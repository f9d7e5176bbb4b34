// How ARGoS was built, for sources that ask: with doubles; libraries are loaded; without Lua and windows.
#pragma once

#define ARGOS_USE_DOUBLE
#define ARGOS_DYNAMIC_LIBRARY_LOADING
#define ARGOS_DYNAMIC_LIBRARY_EXTENSION "so"
