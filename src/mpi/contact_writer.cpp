#include <Eigen/Core>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_data.hpp"
#include "src/mpi/frame_files.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t bytes_per_contact = 169;  // of all datasets

using Contacts = std::vector<DistributedContact>;

/// Members of a contact by the names of their datasets.
template <class T>
using Columns = std::vector<std::pair<const char*, T DistributedContact::*>>;

/// Adds datasets of contacts, with three columns for a vector.
template <class T>
void add_columns(FrameDatasets& datasets, hid_t group, const RankShare& rows,
                 const Contacts& contacts, const Columns<T>& columns) {
  for (const auto& [name, member_of] : columns) {
    const auto member = member_of;
    if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
      datasets.add<double, 3>(group, name, rows, [&contacts, member](auto& to) {
        for (const DistributedContact& contact : contacts) {
          const Eigen::Vector3d& value = contact.*member;
          to.append(value[0], value[1], value[2]);
        }
      });
    } else {
      datasets.add<T>(group, name, rows, [&contacts, member](auto& to) {
        for (const DistributedContact& contact : contacts) {
          to.append(contact.*member);
        }
      });
    }
  }
}

/// Adds contacts as lines from point_a to point_b, for VTK. Points and values are those of the
/// columns, under other names.
void add_lines(FrameDatasets& datasets, hid_t file, hid_t columns, const RankShare& rows,
               std::uint64_t count, const Communicator& ranks) {
  const Hdf5Id vtk = create_group(file, layout::vtk);
  const std::uint64_t end = rows.before + count;
  datasets.add<std::int64_t>(vtk.get(), layout::connectivity, {2 * rows.before, 2 * rows.all},
                             [rows, end](auto& to) {
                               for (std::uint64_t row = rows.before; row < end; ++row) {
                                 to.append(static_cast<std::int64_t>(row));
                                 to.append(static_cast<std::int64_t>(rows.all + row));
                               }
                             });
  // The last rank also writes where the last line ends.
  const std::uint64_t ends = end + (ranks.rank() == ranks.size() - 1 ? 1 : 0);
  datasets.add<std::int64_t>(vtk.get(), layout::offsets, {rows.before, rows.all + 1},
                             [rows, ends](auto& to) {
                               for (std::uint64_t row = rows.before; row < ends; ++row) {
                                 to.append(static_cast<std::int64_t>(2 * row));
                               }
                             });
  datasets.add<std::uint8_t>(vtk.get(), layout::types, rows, [count](auto& to) {
    for (std::uint64_t i = 0; i < count; ++i) {
      to.append(layout::line);
    }
  });
  add_vtk_sizes(datasets, vtk.get(), {2 * rows.all, rows.all, 2 * rows.all}, ranks.rank() == 0);
  const std::string folder = '/' + std::string(layout::contacts) + '/';
  create_view(vtk.get(), layout::points, hdf5_type(double()).file,
              {folder + "point_a", folder + "point_b"}, {rows.all, 3});
  const Hdf5Id at_cells = create_group(vtk.get(), layout::at_cells);
  for (const char* const name :
       {"distance", "fiber_a", "segment_a", "fiber_b", "segment_b", "normal"}) {
    link_dataset(columns, name, at_cells.get(), name);
  }
}

void add_contacts(FrameDatasets& datasets, hid_t file, const Communicator& ranks,
                  const RankShare& rows, const Contacts& contacts) {
  const Hdf5Id group = create_group(file, layout::contacts);
  add_columns(datasets, group.get(), rows, contacts,
              Columns<std::uint64_t>{{"fiber_a", &DistributedContact::fiber_a},
                                     {"segment_a", &DistributedContact::segment_a},
                                     {"fiber_b", &DistributedContact::fiber_b},
                                     {"segment_b", &DistributedContact::segment_b}});
  add_columns(datasets, group.get(), rows, contacts,
              Columns<double>{{"s", &DistributedContact::s},
                              {"t", &DistributedContact::t},
                              {"distance", &DistributedContact::distance},
                              {"lower", &DistributedContact::lower},
                              {"upper", &DistributedContact::upper}});
  add_columns(datasets, group.get(), rows, contacts,
              Columns<Eigen::Vector3d>{{"point_a", &DistributedContact::point_a},
                                       {"point_b", &DistributedContact::point_b},
                                       {"normal", &DistributedContact::normal}});
  add_lines(datasets, file, group.get(), rows, contacts.size(), ranks);
}

}  // namespace

DistributedContactWriter::DistributedContactWriter(MPI_Comm ranks, const std::string& path,
                                                   const DistributedFileOptions& options)
    : DistributedFileWriter(ranks, path, layout::contacts, options) {}

void DistributedContactWriter::write(std::int64_t frame, const DistributedResult& result,
                                     const FiberNames& names) {
  const Communicator& ranks = state_->ranks;
  const RankShare rows = ranks.share(result.contacts.size());
  state_->files.write({frame, layout_version, bytes_per_contact * rows.all + size_of_names(names)},
                      [&](hid_t file, FrameDatasets& datasets) {
                        write_numbers(file, "complete", {result.complete ? 1 : 0});
                        write_numbers(file, "limit_reached", {result.limit_reached ? 1 : 0});
                        write_real(file, "others_lower", result.others_lower);
                        add_contacts(datasets, file, ranks, rows, result.contacts);
                        add_names(datasets, file, names, ranks.rank() == 0);
                      });
}

}  // namespace fiber
