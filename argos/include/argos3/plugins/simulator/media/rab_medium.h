// What range and bearing goes through. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/medium/medium.h>

namespace argos {

class CRABMedium : public CMedium {};

}  // namespace argos
