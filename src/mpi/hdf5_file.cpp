#include "src/mpi/hdf5_file.hpp"

#include <algorithm>
#include <stdexcept>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Keeps the text of the innermost error, which says most.
herr_t keep_reason(unsigned /*depth*/, const H5E_error2_t* error, void* reason) {
  if (error->desc != nullptr && error->desc[0] != '\0') {
    *static_cast<std::string*>(reason) = error->desc;
  }
  return 0;
}

std::string reason_of_failure() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_reason, &reason);
  return reason.empty() ? "" : ": HDF5: " + shortened(reason, 400);
}

/// Times of creation would make two files of the same content differ.
Hdf5Id list_without_times(hid_t kind) {
  Hdf5Id list(H5Pcreate(kind), H5Pclose, "no property list");
  require_success(H5Pset_obj_track_times(list.get(), 0), "no property list");
  return list;
}

/// Access that closes all ids with the file: an open id would keep the file open.
Hdf5Id file_access() {
  Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no property list");
  require_success(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), "no property list");
  return access;
}

Hdf5Id parallel_access(const Communicator& ranks) {
  Hdf5Id access = file_access();
  require_success(H5Pset_fapl_mpio(access.get(), ranks.handle(), MPI_INFO_NULL), "no parallel I/O");
  return access;
}

/// A rank that is alone reads without MPI: where each frame is a file, that takes a third of the
/// time.
Hdf5Id access_alone() {
  Hdf5Id access = file_access();
#if H5_VERSION_GE(1, 10, 7)
  // Some file systems have no locks; MPI-IO does not ask for them either.
  require_success(H5Pset_file_locking(access.get(), 0, 1), "no property list");
#endif
  return access;
}

std::array<hsize_t, 2> sizes_of(Hdf5Shape shape) { return {shape.rows, shape.columns}; }
int rank_of(Hdf5Shape shape) { return shape.columns == 1 ? 1 : 2; }

Hdf5Id space_of(Hdf5Shape shape) {
  return {H5Screate_simple(rank_of(shape), sizes_of(shape).data(), nullptr), H5Sclose, "no space"};
}

/// Selects the rows of a part of a dataset.
Hdf5Id selection(hid_t dataset, std::uint64_t first, Hdf5Shape part) {
  Hdf5Id space(H5Dget_space(dataset), H5Sclose, "a dataset has no space");
  const std::array<hsize_t, 2> start{first, 0};
  require_success(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                      sizes_of(part).data(), nullptr),
                  "rows cannot be selected");
  return space;
}

Hdf5Id scalar_space() { return {H5Screate(H5S_SCALAR), H5Sclose, "no space"}; }

void write_attribute(hid_t place, const std::string& name, hid_t file_type, hid_t memory_type,
                     const Hdf5Id& space, const void* value) {
  const std::string failed = "attribute " + name + " cannot be written";
  const Hdf5Id attribute(
      H5Acreate2(place, name.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      failed);
  require_success(H5Awrite(attribute.get(), memory_type, value), failed);
}

/// An attribute's value if it is of this class.
std::optional<Hdf5Id> open_attribute(hid_t place, const std::string& name, H5T_class_t kind) {
  if (H5Aexists(place, name.c_str()) <= 0) {
    return std::nullopt;
  }
  Hdf5Id attribute(H5Aopen(place, name.c_str(), H5P_DEFAULT), H5Aclose, name + " cannot be read");
  const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose, name + " cannot be read");
  const Hdf5Id space(H5Aget_space(attribute.get()), H5Sclose, name + " cannot be read");
  if (H5Tget_class(type.get()) != kind || H5Sget_simple_extent_npoints(space.get()) != 1) {
    return std::nullopt;
  }
  return attribute;
}

template <class Value>
std::optional<Value> read_attribute(hid_t place, const std::string& name, H5T_class_t kind) {
  const std::optional<Hdf5Id> attribute = open_attribute(place, name, kind);
  if (!attribute) {
    return std::nullopt;
  }
  Value value = 0;
  require_success(H5Aread(attribute->get(), hdf5_type(value).memory, &value),
                  "attribute " + name + " cannot be read");
  return value;
}

}  // namespace

QuietHdf5::QuietHdf5() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

Hdf5Id::Hdf5Id(hid_t id, Close closing, const std::string& what) : id_(id), close_(closing) {
  if (id < 0) {
    throw std::runtime_error(what + reason_of_failure());
  }
}

Hdf5Id::~Hdf5Id() {
  if (id_ >= 0) {
    close_(id_);
  }
}

void Hdf5Id::close(const std::string& what) {
  require_success(close_(std::exchange(id_, -1)), what);
}

void require_success(herr_t result, const std::string& what) {
  if (result < 0) {
    throw std::runtime_error(what + reason_of_failure());
  }
}

Hdf5Id create_parallel_file(const Communicator& ranks, const std::string& path) {
  const Hdf5Id access = parallel_access(ranks);
  const Hdf5Id creation = list_without_times(H5P_FILE_CREATE);
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose,
          "cannot be written"};
}

Hdf5Id open_parallel_file(const Communicator& ranks, const std::string& path) {
  const Hdf5Id access = ranks.size() == 1 ? access_alone() : parallel_access(ranks);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose, "is no whole HDF5 file"};
}

Hdf5Id create_group(hid_t place, const std::string& name) {
  const Hdf5Id creation = list_without_times(H5P_GROUP_CREATE);
  return {H5Gcreate2(place, name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose,
          "group " + name + " cannot be written"};
}

Hdf5Id open_group(hid_t place, const std::string& name) {
  return {H5Gopen2(place, name.c_str(), H5P_DEFAULT), H5Gclose,
          "group " + name + " cannot be read"};
}

bool has_link(hid_t place, const std::string& name) {
  return H5Lexists(place, name.c_str(), H5P_DEFAULT) > 0;
}

void write_numbers(hid_t place, const std::string& name, const std::vector<std::int64_t>& values) {
  const hid_t type = hdf5_type(std::int64_t()).file;
  const Hdf5Id space = values.size() == 1 ? scalar_space() : space_of({values.size()});
  write_attribute(place, name, type, hdf5_type(std::int64_t()).memory, space, values.data());
}

void write_real(hid_t place, const std::string& name, double value) {
  const Hdf5Type type = hdf5_type(value);
  write_attribute(place, name, type.file, type.memory, scalar_space(), &value);
}

void write_text(hid_t place, const std::string& name, const std::string& text) {
  const std::string failed = "attribute " + name + " cannot be written";
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose, failed);
  require_success(H5Tset_size(type.get(), std::max<std::size_t>(text.size(), 1)), failed);
  require_success(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), failed);
  write_attribute(place, name, type.get(), type.get(), scalar_space(), text.c_str());
}

std::optional<std::int64_t> read_number(hid_t place, const std::string& name) {
  return read_attribute<std::int64_t>(place, name, H5T_INTEGER);
}

std::optional<double> read_real(hid_t place, const std::string& name) {
  return read_attribute<double>(place, name, H5T_FLOAT);
}

std::optional<std::string> read_text(hid_t place, const std::string& name) {
  const std::optional<Hdf5Id> attribute = open_attribute(place, name, H5T_STRING);
  if (!attribute) {
    return std::nullopt;
  }
  const std::string failed = "attribute " + name + " cannot be read";
  const Hdf5Id type(H5Aget_type(attribute->get()), H5Tclose, failed);
  if (H5Tis_variable_str(type.get()) != 0) {
    return std::nullopt;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  require_success(H5Aread(attribute->get(), type.get(), text.data()), failed);
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

Hdf5Type hdf5_type(double) { return {H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE}; }
Hdf5Type hdf5_type(std::int64_t) { return {H5T_NATIVE_INT64, H5T_STD_I64LE}; }
Hdf5Type hdf5_type(std::uint64_t) { return {H5T_NATIVE_UINT64, H5T_STD_U64LE}; }
Hdf5Type hdf5_type(std::uint8_t) { return {H5T_NATIVE_UINT8, H5T_STD_U8LE}; }

Hdf5Id create_dataset(hid_t place, const std::string& name, hid_t file_type, Hdf5Shape shape) {
  const Hdf5Id creation = list_without_times(H5P_DATASET_CREATE);
  require_success(H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER), "no property list");
  const Hdf5Id space = space_of(shape);
  return {H5Dcreate2(place, name.c_str(), file_type, space.get(), H5P_DEFAULT, creation.get(),
                     H5P_DEFAULT),
          H5Dclose, "dataset " + name + " cannot be written"};
}

Hdf5Id open_dataset(hid_t place, const std::string& name) {
  return {H5Dopen2(place, name.c_str(), H5P_DEFAULT), H5Dclose,
          "dataset " + name + " cannot be read"};
}

Hdf5Id create_view(hid_t place, const std::string& name, hid_t file_type,
                   const std::vector<std::string>& paths, Hdf5Shape of_each) {
  const std::string failed = "dataset " + name + " cannot be written";
  const Hdf5Shape all{of_each.rows * paths.size(), of_each.columns};
  if (all.rows == 0) {
    return create_dataset(place, name, file_type, all);  // of nothing there can be no view
  }
  const Hdf5Id creation = list_without_times(H5P_DATASET_CREATE);
  const Hdf5Id space = space_of(all);
  const Hdf5Id source = space_of(of_each);
  std::array<hsize_t, 2> start{0, 0};
  for (const std::string& path : paths) {
    require_success(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                        sizes_of(of_each).data(), nullptr),
                    failed);
    require_success(H5Pset_virtual(creation.get(), space.get(), ".", path.c_str(), source.get()),
                    failed);
    start[0] += of_each.rows;
  }
  require_success(H5Sselect_all(space.get()), failed);
  return {H5Dcreate2(place, name.c_str(), file_type, space.get(), H5P_DEFAULT, creation.get(),
                     H5P_DEFAULT),
          H5Dclose, failed};
}

void link_dataset(hid_t group, const std::string& name, hid_t place, const std::string& path) {
  require_success(
      H5Lcreate_hard(group, name.c_str(), place, path.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      "link " + path + " cannot be written");
}

Hdf5Shape shape_of(hid_t dataset) {
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose, "a dataset has no space");
  std::array<hsize_t, 2> sizes{0, 1};
  const int dimensions = H5Sget_simple_extent_ndims(space.get());
  if (dimensions != 1 && dimensions != 2) {
    throw std::runtime_error("a dataset has " + std::to_string(dimensions) +
                             " dimensions, it must have 1 or 2");
  }
  H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr);
  return {sizes[0], sizes[1]};
}

void write_rows(hid_t dataset, hid_t memory_type, std::uint64_t first, Hdf5Shape part,
                const void* values) {
  if (part.rows == 0) {
    return;
  }
  const Hdf5Id memory = space_of(part);
  const Hdf5Id place = selection(dataset, first, part);
  require_success(H5Dwrite(dataset, memory_type, memory.get(), place.get(), H5P_DEFAULT, values),
                  "cannot be written");
}

void read_rows(hid_t dataset, hid_t memory_type, std::uint64_t first, Hdf5Shape part,
               void* values) {
  if (part.rows == 0) {
    return;
  }
  const Hdf5Id memory = space_of(part);
  const Hdf5Id place = selection(dataset, first, part);
  require_success(H5Dread(dataset, memory_type, memory.get(), place.get(), H5P_DEFAULT, values),
                  "cannot be read");
}

}  // namespace fiber
