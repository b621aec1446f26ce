#include "src/mpi/fiber_name_data.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_text.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {

void require_names(const DistributedFibers& fibers) {
  for (const FiberPart& part : fibers.names) {
    if (!fibers.fiber_names.are_indices() && part.fiber >= fibers.fiber_names.size()) {
      throw std::invalid_argument("fibre " + std::to_string(part.fiber) +
                                  " has no name, there are " +
                                  std::to_string(fibers.fiber_names.size()));
    }
  }
}

std::uint64_t size_of_names(const FiberNames& names) { return text_of_names(names).size(); }

void add_names(FrameDatasets& datasets, hid_t place, const FiberNames& names, bool is_root) {
  if (names.are_indices()) {
    return;
  }
  std::vector<char> text = text_of_names(names);
  const std::uint64_t size = text.size();
  datasets.add<std::uint8_t>(place, layout::fiber_names, {0, size},
                             [is_root, text = std::move(text)](auto& rows) {
                               for (std::size_t i = 0; is_root && i < text.size(); ++i) {
                                 rows.append(static_cast<std::uint8_t>(text[i]));
                               }
                             });
}

FiberNames read_names(hid_t place) {
  if (!has_link(place, layout::fiber_names)) {
    return {};
  }
  const Hdf5Id dataset = open_dataset(place, layout::fiber_names);
  const Hdf5Shape shape = shape_of(dataset.get());
  if (shape.columns != 1) {
    throw std::runtime_error("dataset " + std::string(layout::fiber_names) + " has " +
                             std::to_string(shape.columns) + " columns, it must have 1");
  }
  std::vector<char> text(shape.rows);
  read_rows(dataset.get(), hdf5_type(std::uint8_t()).memory, 0, {shape.rows}, text.data());
  return names_in_text(text);
}

}  // namespace fiber
