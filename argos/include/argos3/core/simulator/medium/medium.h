// What signals go through. Only its name: sources include this header without use.
#pragma once

namespace argos {

class CMedium {};

}  // namespace argos
