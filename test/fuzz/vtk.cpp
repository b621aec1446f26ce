// Poly data in VTK's legacy format.
#include "src/io/fiber_formats.hpp"
#include "test/fuzz/format.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fiber::test::fuzz_format(fiber::read_vtk, nullptr, data, size);
}
