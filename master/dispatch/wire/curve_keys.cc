#include "master/dispatch/wire/curve_keys.h"

#include <zmq.h>

#include <array>

#include "base/check.h"

namespace gauntlet {

CurveKeyPair NewCurveKeyPair() {
  std::array<char, 41> public_key{};  // with the zero at the end
  std::array<char, 41> secret_key{};
  GAUNTLET_CHECK(zmq_curve_keypair(public_key.data(), secret_key.data()) == 0,
                 "this ZeroMQ was built without CURVE");
  return {public_key.data(), secret_key.data()};
}

}  // namespace gauntlet
