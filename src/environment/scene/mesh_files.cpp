#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// How much the bytes of a file may cost: several times what large valid ones do.
struct ParseLimits {
  explicit ParseLimits(std::size_t bytes)
      : seconds(1 + bytes / 250'000), memory((std::size_t{256} << 20U) + 100 * bytes) {}

  std::size_t seconds;  // of the processor
  std::size_t memory;   // [byte]
};

/// The content of a file of a mesh.
struct ParsedMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< [m]
  std::vector<TriangleMesh::Triangle> triangles;
};

constexpr std::uint64_t max_vertices = 3 * TriangleMesh::max_triangles;

/// The process that reads a mesh writes this first.
struct MeshCounts {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void refuse_for_system(const char* what) {
  throw std::invalid_argument(std::string(what) + ": " + std::generic_category().message(errno));
}

// ---- in the child: nothing is thrown, and no destructor of the parent's is called ---------------

void set_limit(int resource, std::size_t most) {
  const rlimit limits{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// @param used address space that the parent has [byte]; 0 if that is not known
void enter_limits(const ParseLimits& limits, std::size_t used) {
  for (const int signal :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGALRM, SIGTERM, SIGINT}) {
    std::signal(signal, SIG_DFL);
  }
  sigset_t none;  // threads of roscpp block all of them
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // It may have to wait for the processor, and for a lock that another thread held when it began.
  alarm(static_cast<unsigned>(10 * limits.seconds));
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, limits.seconds);
  if (used > 0) {
    set_limit(RLIMIT_AS, used + limits.memory);
  }
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

/// Appends the triangles of a node and of those below it.
/// @param pose of what the node is in
void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& pose, ParsedMesh& mesh) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned vertex = 0; vertex < part.mNumVertices; ++vertex) {
      const aiVector3D placed = pose * part.mVertices[vertex];
      mesh.vertices.emplace_back(placed.x, placed.y, placed.z);
    }
    for (unsigned face = 0; face < part.mNumFaces; ++face) {
      const aiFace& corners = part.mFaces[face];
      if (corners.mNumIndices == 3) {  // or it is a point or a line
        mesh.triangles.push_back({first + corners.mIndices[0], first + corners.mIndices[1],
                                  first + corners.mIndices[2]});
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_node(scene, *node.mChildren[i], pose * node.mChildren[i]->mTransformation, mesh);
  }
}

/// The mesh that assimp makes of the bytes. The root's transformation is left out, as rviz does it:
/// assimp turns files there so that y is up, and in ROS z is.
ParsedMesh parse(const std::string& bytes, const std::string& name) {
  Assimp::Importer importer;
  // Vertices that differ in nothing but what is removed are one.
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  std::string format = name.substr(name.rfind('.') + 1);  // all of it without a dot
  std::transform(format.begin(), format.end(), format.begin(),
                 [](unsigned char letter) { return std::tolower(letter); });
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_RemoveComponent | aiProcess_JoinIdenticalVertices | aiProcess_Triangulate,
      format.c_str());
  ParsedMesh mesh;
  if (scene != nullptr && scene->mRootNode != nullptr) {
    add_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
  }
  return mesh;
}

void parse_and_write(const std::string& bytes, const std::string& name, std::FILE* file) {
  const ParsedMesh mesh = parse(bytes, name);
  const MeshCounts counts{mesh.vertices.size(), mesh.triangles.size()};
  std::fwrite(&counts, sizeof counts, 1, file);
  if (counts.triangles > 0 && counts.vertices <= max_vertices &&
      counts.triangles <= TriangleMesh::max_triangles) {
    std::fwrite(mesh.vertices.data(), sizeof(Eigen::Vector3d), counts.vertices, file);
    std::fwrite(mesh.triangles.data(), sizeof(TriangleMesh::Triangle), counts.triangles, file);
  }
  std::fflush(file);
}

[[noreturn]] void run_child(const std::string& bytes, const std::string& name, std::FILE* file,
                            std::size_t used) {
  enter_limits(ParseLimits(bytes.size()), used);
  try {
    parse_and_write(bytes, name, file);
  } catch (...) {  // what is missing in the file tells
  }
  _exit(0);
}

// ---- in the parent -----------------------------------------------------------------------------

std::size_t used_address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void check_counts(const MeshCounts& counts) {
  if (counts.triangles == 0) {
    throw std::invalid_argument("it holds no mesh in a format that assimp reads");
  }
  constexpr std::uint64_t most = TriangleMesh::max_triangles;
  if (counts.triangles > most) {
    throw std::invalid_argument("the mesh has " + std::to_string(counts.triangles) +
                                " triangles, it may have at most " + std::to_string(most));
  }
}

/// Lets assimp take a file's bytes apart, in a process of its own that ends with it: there are
/// files it crashes on, does not come back from, or takes all memory for, and these are to cost
/// only themselves.
/// @param name of the file, which tells the format
/// @throws std::invalid_argument if there is no mesh in it or too large a one, or assimp fails
ParsedMesh parse_mesh(const std::string& bytes, const std::string& name) {
  const ParseLimits limits(bytes.size());
  const std::size_t used = used_address_space();
  const int number = memfd_create("mesh", MFD_CLOEXEC);
  const std::unique_ptr<std::FILE, CloseFile> file(number < 0 ? nullptr : fdopen(number, "w+"));
  if (file == nullptr) {
    refuse_for_system("no memory for the process that reads it");
  }
  const pid_t process = fork();
  if (process < 0) {
    refuse_for_system("no process to read it");
  }
  if (process == 0) {
    run_child(bytes, name, file.get(), used);
  }
  while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
  }
  std::rewind(file.get());
  MeshCounts counts;
  ParsedMesh mesh;
  const auto read = [&file](auto& values, std::uint64_t count) {
    values.resize(count);
    return std::fread(values.data(), sizeof values.front(), count, file.get()) == count;
  };
  bool is_whole = std::fread(&counts, sizeof counts, 1, file.get()) == 1;
  if (is_whole) {
    check_counts(counts);
    is_whole = counts.vertices <= max_vertices && read(mesh.vertices, counts.vertices) &&
               read(mesh.triangles, counts.triangles);
  }
  if (!is_whole) {
    throw std::invalid_argument("assimp fails on it: it crashes, takes more than " +
                                std::to_string(limits.seconds) + " s or more than " +
                                std::to_string(limits.memory >> 20U) + " MB");
  }
  return mesh;
}

// ---- files

using std::filesystem::path;

std::string read_bytes(const path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw std::invalid_argument("there is no file " + quote(file.string()));
  }
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size > max_mesh_file_size) {
    throw std::invalid_argument("the file has " + std::to_string(size) +
                                " bytes, it may have at most " +
                                std::to_string(max_mesh_file_size));
  }
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw std::invalid_argument("the file " + quote(file.string()) + " cannot be read");
  }
  return bytes;
}

void check_scale(const Eigen::Vector3d& scale) {
  if (!(scale.allFinite() && (scale.array() != 0.0).all())) {
    std::ostringstream message;
    message << "scale is (" << scale.x() << ", " << scale.y() << ", " << scale.z()
            << "), its numbers must be finite and not 0";
    throw std::invalid_argument(message.str());
  }
}

}  // namespace

std::shared_ptr<const TriangleMesh> read_mesh_file(const path& file, const Eigen::Vector3d& scale) {
  check_scale(scale);
  ParsedMesh mesh = parse_mesh(read_bytes(file), file.filename().string());
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = scale.cwiseProduct(vertex);
  }
  const bool is_mirrored = (scale.array() < 0.0).count() % 2 == 1;
  if (is_mirrored) {
    for (TriangleMesh::Triangle& triangle : mesh.triangles) {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return std::make_shared<const TriangleMesh>(std::move(mesh.vertices), std::move(mesh.triangles));
}

MeshSource mesh_files(const path& folder) {
  return [folder](const std::string& resource, const Eigen::Vector3d& scale) {
    return with_context("mesh " + quote(resource), [&] {
      const std::string scheme = "file://";
      if (resource.rfind("package://", 0) == 0) {
        throw std::invalid_argument(
            "packages are found with ROS only, it must be file:///PATH or a path");
      }
      const bool has_scheme = resource.rfind(scheme, 0) == 0;
      return read_mesh_file(folder / resource.substr(has_scheme ? scheme.size() : 0), scale);
    });
  };
}

}  // namespace fiber
