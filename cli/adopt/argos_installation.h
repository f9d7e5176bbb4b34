// The ARGoS3 that is installed on this machine.
#pragma once

#include <ostream>
#include <string>

#include "base/result.h"

namespace gauntlet {

struct ArgosInstallation {
  std::string program;  // the absolute path of argos3
  std::string prefix;   // where it was installed; its headers are in include/argos3
};

// The argos3 that PATH finds. Error: there is none, or its headers are not beside it.
Result<ArgosInstallation> FindArgos();

// Compiles the recorder (argos/recorder) with $CXX, else c++, against the installation's headers, into this
// file. `said` gets the compiler's errors. Error: it does not compile.
Status CompileRecorder(const ArgosInstallation& argos, const std::string& file, std::ostream& said);

}  // namespace gauntlet
