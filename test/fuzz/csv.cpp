// Fibre files as CSV.
#include <sstream>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/fuzz/fuzz_target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fiber::test::Bounds bounds(fiber::test::times(200, size));
  std::istringstream stream(fiber::test::text_of(data, size));
  try {
    fiber::read_csv(stream, "fuzz.csv", 0.01);
  } catch (const fiber::FileError& error) {
    fiber::test::check_error(error);
  }
  return 0;
}
