// Fibres for ParaView: .vtp, VTK's poly data in XML, and .pvd, which names one for each frame.
#include <cstdio>
#include <filesystem>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/number.hpp"

namespace fiber {
namespace {

std::string in_xml(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    escaped += letter == '&'   ? "&amp;"
               : letter == '<' ? "&lt;"
               : letter == '"' ? "&quot;"
                               : std::string(1, letter);
  }
  return escaped;
}

/// An array of a VTK file: whatever write() appends to a text for each index, a line each.
template <class Write>
void write_array(std::ostream& stream, const std::string& attributes, std::size_t count,
                 const Write& write) {
  constexpr std::size_t long_text = 65'536;  // [byte]
  stream << "<DataArray " << attributes << " format=\"ascii\">\n";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    write(text, i);
    text += '\n';
    if (text.size() > long_text) {
      stream << text;
      text.clear();
    }
  }
  stream << text << "</DataArray>\n";
}

/// The file of a frame, beside the one that names it.
std::filesystem::path frame_path(const std::string& path, std::int64_t frame) {
  char number[32];
  std::snprintf(number, sizeof number, "_%06lld.vtp", static_cast<long long>(frame));
  const std::filesystem::path pvd(path);
  return pvd.parent_path() / (pvd.stem().string() + number);
}

}  // namespace

void write_vtp(std::ostream& stream, const FiberAssembly& fibers) {
  const FiberTopology topology = fibers.topology();
  const std::vector<std::uint32_t>& given = fibers.given_offsets();
  const std::size_t points = given.back();
  const std::size_t lines = fibers.fiber_count();
  std::vector<std::size_t> fiber_of(points);
  for (std::size_t fiber = 0; fiber < lines; ++fiber) {
    for (std::size_t i = given[fiber]; i < given[fiber + 1]; ++i) {
      fiber_of[i] = fiber;
    }
  }
  // The point of a fibre as it is stored, where closed fibres have their first one again.
  const auto stored = [&](std::size_t i) {
    return i + (fibers.offsets()[fiber_of[i]] - given[fiber_of[i]]);
  };
  stream << "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "<PolyData>\n<Piece NumberOfPoints=\""
         << points << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << lines
         << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"radius\">\n";
  write_array(stream, "type=\"Float64\" Name=\"radius\"", points,
              [&](std::string& text, std::size_t i) {
                append_number(text, fibers.radius_at(fiber_of[i], stored(i)));
              });
  write_array(stream, "type=\"Int64\" Name=\"fiber\"", points,
              [&](std::string& text, std::size_t i) { append_number(text, fiber_of[i]); });
  if (!topology.joints.empty()) {
    write_array(stream, "type=\"Int32\" Name=\"joint\"", points,
                [&](std::string& text, std::size_t i) { append_number(text, topology.joints[i]); });
  }
  stream << "</PointData>\n<Points>\n";
  write_array(stream, "type=\"Float64\" NumberOfComponents=\"3\"", points,
              [&](std::string& text, std::size_t i) {
                const Eigen::Vector3d& point = fibers.points()[stored(i)];
                for (const double coordinate : {point.x(), point.y(), point.z()}) {
                  append_number(text, coordinate);
                  text += ' ';
                }
              });
  stream << "</Points>\n<Lines>\n";
  write_array(stream, "type=\"Int64\" Name=\"connectivity\"", points,
              [&](std::string& text, std::size_t i) {
                append_number(text, i);
                const std::size_t fiber = fiber_of[i];
                if (i + 1 == given[fiber + 1] && fibers.is_closed(fiber)) {
                  text += '\n';
                  append_number(text, given[fiber]);  // a closed line ends where it begins
                }
              });
  write_array(
      stream, "type=\"Int64\" Name=\"offsets\"", lines,
      [&](std::string& text, std::size_t i) { append_number(text, fibers.offsets()[i + 1]); });
  stream << "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

PvdWriter::PvdWriter(const std::string& path) : path_(path), file_(path) {
  append(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n");
}

void PvdWriter::write(const FiberFrame& frame, double time) {
  const std::filesystem::path file = frame_path(path_, frame.frame);
  OutputFile output(file.string());
  write_vtp(output.stream(), frame.fibers);
  output.close();
  std::string entry = "<DataSet timestep=\"";
  append_number(entry, time);
  append(entry + "\" part=\"0\" file=\"" + in_xml(file.filename().string()) + "\"/>\n");
}

/// Writes in place of the last tags, and these again.
void PvdWriter::append(const std::string& text) {
  std::ostream& stream = file_.stream();
  stream.seekp(end_);
  stream << text;
  end_ = stream.tellp();
  stream << "</Collection>\n</VTKFile>\n" << std::flush;
  file_.check();
}

}  // namespace fiber
