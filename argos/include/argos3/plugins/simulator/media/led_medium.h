// What LEDs are seen through. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/medium/medium.h>

namespace argos {

class CLEDMedium : public CMedium {};

}  // namespace argos
