// Standard output as a stream that knows why writing failed.
#pragma once

#include <array>
#include <streambuf>

namespace gauntlet {

// Buffers and writes to a file descriptor, again after interruptions. The first failure is kept, and
// everything after it is dropped. Not thread-safe.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor);
  DescriptorBuffer(const DescriptorBuffer&) = delete;
  DescriptorBuffer& operator=(const DescriptorBuffer&) = delete;
  ~DescriptorBuffer() override = default;  // what was not flushed is lost

  int error() const { return error_; }  // errno of the first failure, 0 = none

 protected:
  int_type overflow(int_type character) override;
  int sync() override;

 private:
  int descriptor_;
  int error_ = 0;
  std::array<char, 1U << 16> buffer_{};
};

// Opens /dev/null for each of the descriptors 0, 1 and 2 that is closed, so that no file that is opened later
// gets its number and the program's output. Writing to such a standard output fails.
void ReserveStandardDescriptors();

}  // namespace gauntlet
