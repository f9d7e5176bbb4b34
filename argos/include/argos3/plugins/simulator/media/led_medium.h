// Only a name.
#pragma once

#include <argos3/core/simulator/only_names.h>
