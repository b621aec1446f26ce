#include "src/io/file_format.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "fiber_proximity/io/file.hpp"
#include "src/text/lower_case.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// A format, and how to know it.
struct KnownFormat {
  FileFormat format;
  const char* name;
  std::vector<std::string_view> ends;    // of file names
  std::vector<std::string_view> begins;  // of files
  // Whether fibres are read and written, if not by the tools that run over ranks alone.
  bool is_read = false;
  bool is_written = false;
};

constexpr const char* what_is_read =
    "CSV, .hair, .npz, .swc, .tck, .trk, .vtk and .vtp are read, and .h5 by fiber_query_mpi";
constexpr const char* what_is_written =
    "CSV, .hair, .npz, .pvd, .tck, .trk and .vtp are written, and .h5 by fiber_query_mpi convert";

/// Names that mean none of these are taken for CSV, so a format that people have fibres in, or take
/// such a name for, has a line here.
const std::vector<KnownFormat>& known_formats() {
  using namespace std::string_view_literals;
  static const std::vector<KnownFormat> formats{
      {FileFormat::CSV, "CSV", {".csv", ".tsv"}, {}, true, true},
      {FileFormat::HAIR, "HAIR", {".hair"}, {"HAIR"}, true, true},
      {FileFormat::TCK, "MRtrix's tracks", {".tck"}, {"mrtrix"}, true, true},
      {FileFormat::TRK, "TrackVis's tracks", {".trk"}, {"TRACK\0"sv}, true, true},
      {FileFormat::HDF5, "HDF5", {".h5", ".hdf5", ".hdf", ".vtkhdf"}, {"\x89HDF"}},
      {FileFormat::PVD, "a collection of VTK", {".pvd"}, {}, false, true},
      {FileFormat::VTP, "VTK", {".vtp"}, {"<?xml", "<VTKFile"}, true, true},
      {FileFormat::VTK, "VTK", {".vtk"}, {"# vtk"}, true, false},
      {FileFormat::JSON, "JSON", {".json", ".jsonl"}, {"{", "["}},
      {FileFormat::OTHER, "VTK", {".vtu"}, {}},
      {FileFormat::OTHER, "NumPy", {".npy"}, {"\x93NUMPY"}},
      {FileFormat::NPZ, "NumPy's archive", {".npz"}, {}, true, true},
      {FileFormat::OTHER, "tractography", {".trx"}, {}},
      {FileFormat::SWC, "SWC", {".swc"}, {}, true, false},
      {FileFormat::OTHER, "XYZ", {".xyz"}, {}},
      {FileFormat::OTHER, "PLY", {".ply"}, {"ply"}},
      {FileFormat::OTHER, "OBJ", {".obj"}, {}},
      {FileFormat::OTHER, "STL", {".stl"}, {"solid "}},
      {FileFormat::OTHER, "PCD", {".pcd"}, {"# .PCD"}},
      {FileFormat::OTHER, "Alembic", {".abc"}, {"Ogawa"}},
      {FileFormat::OTHER, "USD", {".usd", ".usda", ".usdc", ".usdz"}, {"#usda", "PXR-USDC"}},
      {FileFormat::OTHER, "BCC", {".bcc"}, {"BCC"}},
      {FileFormat::OTHER, "MATLAB", {".mat"}, {"MATLAB"}},
      {FileFormat::OTHER, "XML", {".xml", ".sdf", ".urdf"}, {"<"}},
      {FileFormat::OTHER, "YAML", {".yaml", ".yml"}, {}},
      {FileFormat::OTHER, "a spreadsheet", {".xlsx", ".xls", ".ods"}, {}},
      {FileFormat::OTHER, "Parquet", {".parquet"}, {"PAR1"}},
      {FileFormat::OTHER, "pickle", {".pkl", ".pickle"}, {}},
      {FileFormat::OTHER, "a ROS bag", {".bag", ".mcap"}, {"#ROSBAG"}},
      {FileFormat::OTHER,
       "compressed",
       {".gz", ".bz2", ".xz", ".zst", ".zip"},
       {"\x1f\x8b", "PK\x03"}},
  };
  return formats;
}

/// @return nullptr for a name that means no format
const KnownFormat* format_of_name(const std::string& path) {
  const std::string end = lower_case(std::filesystem::path(path).extension().string());
  for (const KnownFormat& known : known_formats()) {
    if (std::find(known.ends.begin(), known.ends.end(), end) != known.ends.end()) {
      return &known;
    }
  }
  return nullptr;
}

}  // namespace

std::optional<FileFormat> format_meant(const std::string& path) {
  const KnownFormat* const known = format_of_name(path);
  return known == nullptr ? std::nullopt : std::make_optional(known->format);
}

FileFormat format_of(const std::string& path) {
  return format_meant(path).value_or(FileFormat::CSV);
}

std::string format_of_content(std::string_view begin) {
  for (const KnownFormat& known : known_formats()) {
    for (const std::string_view bytes : known.begins) {
      if (begin.substr(0, bytes.size()) == bytes) {
        return std::string(known.name) + ", by its name CSV; " + what_is_read;
      }
    }
  }
  return "";
}

bool holds_one_frame(FileFormat format) {
  return format != FileFormat::CSV && format != FileFormat::PVD &&
         std::any_of(known_formats().begin(), known_formats().end(), [&](const KnownFormat& known) {
           return known.format == format && known.is_written;
         });
}

void require_format_to_read(const std::string& path) {
  const KnownFormat* const known = format_of_name(path);
  if (known != nullptr && !known->is_read) {
    throw FileError(path, "is " + std::string(known->name) + " by its name; " + what_is_read);
  }
}

void require_format_to_write(const std::string& path) {
  const KnownFormat* const known = format_of_name(path);
  if (known != nullptr && !known->is_written) {
    throw std::invalid_argument(quote(path) + " is a name of " + known->name + "; " +
                                what_is_written);
  }
}

void require_format(FileFormat format, const std::string& what, const std::string& path) {
  const KnownFormat* const meant = format_of_name(path);
  if (meant != nullptr && meant->format != format) {
    const auto written =
        std::find_if(known_formats().begin(), known_formats().end(),
                     [&](const KnownFormat& known) { return known.format == format; });
    throw std::invalid_argument(what + ": " + quote(path) + " is a name of " + meant->name +
                                ", what is written is " + written->name);
  }
}

}  // namespace fiber
