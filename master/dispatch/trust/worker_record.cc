#include "master/dispatch/trust/worker_record.h"

#include <fmt/format.h>

namespace gauntlet {

std::string InWords(const WorkerRecord& record) {
  return fmt::format(
      "{} of its {} failed runs were finished by other workers, {} of its answers could not be read or were "
      "to leases that are not its own, and {} of its runs ended well",
      record.contradicted, record.failed, record.strikes, record.finished);
}

}  // namespace gauntlet
