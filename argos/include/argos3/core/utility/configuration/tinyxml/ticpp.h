// The XML library of ARGoS, as far as parameters need it.
#pragma once

#include <argos3/core/utility/configuration/argos_configuration.h>
