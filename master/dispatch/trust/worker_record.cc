#include "master/dispatch/trust/worker_record.h"

#include <fmt/format.h>

namespace gauntlet {

std::string InWords(const WorkerRecord& record) {
  if (record.failed_alone > 0) {
    return fmt::format("its last {} runs failed, and other workers finished nearly all of theirs meanwhile",
                       record.failed_alone);
  }
  if (record.finished == 0 && record.returned >= WorkerRecord::kMostReturned)
    return fmt::format("it gave back {} leases in a row, and finished nothing", record.returned);
  if (record.finished == 0 && record.outside >= WorkerRecord::kMostFaults) {
    return fmt::format(
        "{} of its runs, as it says, were ended from outside and then finished by other workers; it finished "
        "nothing",
        record.outside);
  }
  if (record.finished == 0 && record.hoarded >= WorkerRecord::kMostFaults) {
    return fmt::format(
        "it kept {} runs unusually long, until other workers had finished them; it finished nothing",
        record.hoarded);
  }
  return fmt::format(
      "{} of its {} failed runs were finished by other workers, {} of its answers could not be read or were "
      "to leases that are not its own, and {} of its runs ended well",
      record.contradicted, record.failed, record.strikes, record.finished);
}

}  // namespace gauntlet
