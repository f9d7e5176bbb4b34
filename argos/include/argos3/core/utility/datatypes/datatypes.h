// The number types of ARGoS' interface.
#pragma once

// Sources rely on these coming along.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace argos {

using SInt8 = signed char;
using UInt8 = unsigned char;
using SInt16 = signed short;
using UInt16 = unsigned short;
using SInt32 = signed int;
using UInt32 = unsigned int;
using SInt64 = signed long long;
using UInt64 = unsigned long long;
using Real = double;

// As numbers, not as characters.
inline std::ostream& operator<<(std::ostream& stream, UInt8 value) {
  return stream << static_cast<unsigned int>(value);
}
inline std::ostream& operator<<(std::ostream& stream, SInt8 value) {
  return stream << static_cast<int>(value);
}

}  // namespace argos
