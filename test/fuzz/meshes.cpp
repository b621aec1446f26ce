// Files of meshes. An input is a byte, which format, and the file. What assimp does to the process
// that reads a file is no finding: it crashes and hangs on many. What it makes of the others is
// looked at. `fuzz_meshes --write_seeds=test/fuzz/corpus/meshes` writes the seeds.
#include <pthread.h>
#include <sanitizer/common_interface_defs.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "test/fuzz/fuzz_target.hpp"
#include "test/fuzz/seeds.hpp"
#include "test/support/temporary_directory.hpp"

namespace {

const char* const formats[] = {"stl", "dae", "obj", "ply"};

const fiber::test::TemporaryDirectory& folder() {
  static const fiber::test::TemporaryDirectory folder;
  return folder;
}

void try_mesh(const std::string& file) {
  const auto mesh = fiber::read_mesh_file(file, Eigen::Vector3d(1.0, -2.0, 0.5));
  for (const fiber::TriangleMesh::Triangle& triangle : mesh->triangles()) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh->vertices().size()) {
        fiber::test::finding("a triangle of vertices that are not there");
      }
    }
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) {
    return 0;
  }
  const std::string file =
      folder().path(std::string("mesh.") + formats[data[0] % std::size(formats)]);
  std::ofstream(file, std::ios::binary) << fiber::test::text_of(data + 1, size - 1);
  const fiber::test::Bounds bounds(fiber::test::times(2000, size));
  try {
    try_mesh(file);
  } catch (const std::invalid_argument& error) {
    fiber::test::check_error(error);
  }
  return 0;
}

namespace {

std::string seed(char format, const std::string& file) { return format + file; }

const char* const ascii_stl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid a\n";

const char* const obj =
    "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvt 0 0\n"
    "f 1/1/1 3//1 2\nf 1 2 4\ng b\nf 1 4 3\nf 2 3 4\nf -1 -2 -3\n";

const char* const ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n";

const char* const dae =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\"><asset><unit meter=\"0.1\"/><up_axis>Z_UP</up_axis></asset>"
    "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" "
    "count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source=\"#a\" "
    "count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
    "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"v\">"
    "<input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\">"
    "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh>"
    "</geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
    "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
    "<instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";

std::string binary_stl() {
  std::string bytes(80, ' ');
  const std::uint32_t count = 2;
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  const float corners[2][12] = {{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0},
                                {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0}};
  for (const auto& triangle : corners) {
    bytes.append(reinterpret_cast<const char*>(triangle), sizeof triangle);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string binary_ply() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
  const std::int32_t face[3] = {0, 1, 2};
  bytes += '\3';
  return bytes.append(reinterpret_cast<const char*>(face), sizeof face);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  fiber::test::write_seeds(*argc, *argv,
                           {{"ascii.stl", seed(0, ascii_stl)},
                            {"binary.stl", seed(0, binary_stl())},
                            {"triangle.dae", seed(1, dae)},
                            {"tetrahedron.obj", seed(2, obj)},
                            {"ascii.ply", seed(3, ply)},
                            {"binary.ply", seed(3, binary_ply())}});
  // Or a crash of the process that reads a file would be told as one of this, which has other
  // bounds.
  pthread_atfork(nullptr, nullptr, [] {
    __sanitizer_set_death_callback(nullptr);
    fiber::test::Bounds::lift();
  });
  return 0;
}
