#pragma once

#include <ostream>
#include <string>

#include "fiber_proximity/io/fiber_frame.hpp"
#include "fiber_proximity/io/output_file.hpp"

namespace fiber {

/// Writes fibres over time for ParaView: NAME.pvd names a file for each frame beside it,
/// NAME_000000.vtp and so on, with the fibres as poly lines and `radius` [m] and `fiber`, the
/// index, at their points. All numbers read back as the same. What is written can be opened after
/// each frame.
class PvdWriter {
 public:
  /// @param path of the .pvd file
  /// @throws FileError
  explicit PvdWriter(const std::string& path);

  /// @param time of the frame [s]
  /// @throws FileError
  void write(const FiberFrame& frame, double time);

 private:
  void append(const std::string& text);

  const std::string path_;
  OutputFile file_;
  std::streampos end_;  // of the frames in the file, where the last tags begin
};

/// Writes fibres as a VTK file of poly data, in XML, to a stream, which is not checked for errors.
void write_vtp(std::ostream& stream, const FiberAssembly& fibers);

}  // namespace fiber
