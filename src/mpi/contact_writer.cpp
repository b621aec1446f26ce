#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_data.hpp"
#include "src/mpi/frame_files.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t bytes_per_contact = 169;  // of all datasets

/// The rows that contacts of this rank take among those of all ranks.
struct ContactRows {
  std::uint64_t first = 0;
  std::uint64_t all = 0;
};

ContactRows rows_of(const Communicator& ranks, std::uint64_t count) {
  ContactRows rows;
  const std::vector<std::uint64_t> counts = ranks.gather_all(count);
  for (int other = 0; other < ranks.size(); ++other) {
    const std::uint64_t some = counts[static_cast<std::size_t>(other)];
    rows.first += other < ranks.rank() ? some : 0;
    rows.all += some;
  }
  return rows;
}

/// A column of contacts: a dataset, with three columns for a vector.
template <class T>
class ContactColumn {
 public:
  ContactColumn(hid_t group, const char* name, const ContactRows& rows,
                T DistributedContact::*member)
      : writer_(group, name, rows.all, rows.first), member_(member) {}

  void append(const DistributedContact& contact) {
    const T& value = contact.*member_;
    if constexpr (is_vector) {
      writer_.append(value[0], value[1], value[2]);
    } else {
      writer_.append(value);
    }
  }
  void flush() { writer_.flush(); }

 private:
  static constexpr bool is_vector = std::is_same_v<T, Eigen::Vector3d>;
  using Writer = std::conditional_t<is_vector, RowWriter<double, 3>, RowWriter<T>>;

  Writer writer_;
  T DistributedContact::*member_;
};

/// Contacts as lines from point_a to point_b, for VTK. Points and values are those of the columns,
/// under other names.
class ContactLines {
 public:
  ContactLines(hid_t file, hid_t columns, const ContactRows& rows)
      : vtk_(create_group(file, layout::vtk)),
        rows_(rows),
        connectivity_(vtk_.get(), layout::connectivity, 2 * rows.all, 2 * rows.first),
        offsets_(vtk_.get(), layout::offsets, rows.all + 1, rows.first),
        types_(vtk_.get(), layout::types, rows.all, rows.first),
        sizes_(vtk_.get(), {2 * rows.all, rows.all, 2 * rows.all}) {
    const std::string folder = '/' + std::string(layout::contacts) + '/';
    create_view(vtk_.get(), layout::points, hdf5_type(double()).file,
                {folder + "point_a", folder + "point_b"}, {rows.all, 3});
    const Hdf5Id at_cells = create_group(vtk_.get(), layout::at_cells);
    for (const char* const name :
         {"distance", "fiber_a", "segment_a", "fiber_b", "segment_b", "normal"}) {
      link_dataset(columns, name, at_cells.get(), name);
    }
  }

  void write(std::uint64_t count, bool is_root) {
    for (std::uint64_t row = rows_.first; row < rows_.first + count; ++row) {
      connectivity_.append(static_cast<std::int64_t>(row));
      connectivity_.append(static_cast<std::int64_t>(rows_.all + row));
      offsets_.append(static_cast<std::int64_t>(2 * row));
      types_.append(layout::line);
    }
    connectivity_.flush();
    offsets_.flush();
    types_.flush();
    if (is_root) {
      sizes_.write();
      write_end(offsets_.dataset(), {rows_.all, 2 * rows_.all});
    }
  }

 private:
  Hdf5Id vtk_;
  const ContactRows rows_;
  RowWriter<std::int64_t> connectivity_;
  RowWriter<std::int64_t> offsets_;
  RowWriter<std::uint8_t> types_;
  VtkSizes sizes_;
};

/// The datasets of a frame. All ranks make them alike, then each writes its rows.
class ContactDatasets {
 public:
  ContactDatasets(hid_t file, const ContactRows& rows)
      : group_(create_group(file, layout::contacts)),
        ids_{{{group_.get(), "fiber_a", rows, &DistributedContact::fiber_a},
              {group_.get(), "segment_a", rows, &DistributedContact::segment_a},
              {group_.get(), "fiber_b", rows, &DistributedContact::fiber_b},
              {group_.get(), "segment_b", rows, &DistributedContact::segment_b}}},
        numbers_{{{group_.get(), "s", rows, &DistributedContact::s},
                  {group_.get(), "t", rows, &DistributedContact::t},
                  {group_.get(), "distance", rows, &DistributedContact::distance},
                  {group_.get(), "lower", rows, &DistributedContact::lower},
                  {group_.get(), "upper", rows, &DistributedContact::upper}}},
        vectors_{{{group_.get(), "point_a", rows, &DistributedContact::point_a},
                  {group_.get(), "point_b", rows, &DistributedContact::point_b},
                  {group_.get(), "normal", rows, &DistributedContact::normal}}},
        lines_(file, group_.get(), rows) {}

  void write(const std::vector<DistributedContact>& contacts, bool is_root) {
    const auto write_columns = [&](auto& columns) {
      for (auto& column : columns) {
        for (const DistributedContact& contact : contacts) {
          column.append(contact);
        }
        column.flush();
      }
    };
    write_columns(ids_);
    write_columns(numbers_);
    write_columns(vectors_);
    lines_.write(contacts.size(), is_root);
  }

 private:
  Hdf5Id group_;
  std::array<ContactColumn<std::uint64_t>, 4> ids_;
  std::array<ContactColumn<double>, 5> numbers_;
  std::array<ContactColumn<Eigen::Vector3d>, 3> vectors_;
  ContactLines lines_;
};

}  // namespace

struct DistributedContactWriter::State {
  State(MPI_Comm comm, const std::string& path, const DistributedFileOptions& options)
      : ranks(comm), files(ranks, path, layout::contacts, options) {}

  Communicator ranks;
  FrameFiles files;
};

DistributedContactWriter::DistributedContactWriter(MPI_Comm ranks, const std::string& path,
                                                   const DistributedFileOptions& options)
    : state_(std::make_unique<State>(ranks, path, options)) {}

DistributedContactWriter::~DistributedContactWriter() = default;

std::size_t DistributedContactWriter::done() const { return state_->files.done(); }

void DistributedContactWriter::write(std::int64_t frame, const DistributedResult& result,
                                     const FiberNames& names) {
  const Communicator& ranks = state_->ranks;
  const ContactRows rows = rows_of(ranks, result.contacts.size());
  state_->files.write(frame, bytes_per_contact * rows.all + size_of_names(names),
                      [&](hid_t file) -> std::function<void()> {
                        write_numbers(file, "complete", {result.complete ? 1 : 0});
                        write_numbers(file, "limit_reached", {result.limit_reached ? 1 : 0});
                        write_real(file, "others_lower", result.others_lower);
                        const auto datasets = std::make_shared<ContactDatasets>(file, rows);
                        return [&, datasets, write_names = create_names(file, names)] {
                          datasets->write(result.contacts, ranks.rank() == 0);
                          if (ranks.rank() == 0) {
                            write_names();
                          }
                        };
                      });
}

void DistributedContactWriter::finish() { state_->files.finish(); }

}  // namespace fiber
