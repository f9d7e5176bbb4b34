// What LEDs are seen through. Only its name.
#pragma once

namespace argos {

class CLEDMedium {};

}  // namespace argos
