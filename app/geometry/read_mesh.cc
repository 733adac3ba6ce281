#include "app/geometry/read_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include "app/core/file_kind.h"
#include "app/geometry/read_in_child.h"
#include "app/geometry/read_ply.h"
#include "app/geometry/read_text_mesh.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 256ULL << 20U;
constexpr std::size_t kMaxTriangles = 2'000'000;
constexpr const char* kFormats = ".ply, .obj, .stl, .off, .gltf, .glb, .dae, .3ds";

std::string Extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void RequireReadable(const fs::path& file) {
  const std::string clause = NonFileClause(file);
  if (!clause.empty()) throw UnreadableFile("a file", clause);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) throw UnreadableFile("a readable file", "which cannot be read");
  if (bytes == 0) throw UnreadableFile("a file with a shape in it", "which is empty");
  if (bytes > kMaxBytes) {
    throw UnreadableFile("a file of at most 256 MB", fmt::format("which has {} MB", bytes >> 20U));
  }
  const std::string extension = Extension(file);
  if (extension.empty() ||
      (std::string(kFormats) + ",").find(extension + ",") == std::string::npos) {
    throw UnreadableFile(std::string("one of ") + kFormats, "");
  }
}

// What a mesh file may name: other plain files in its own folder and below. A pipe would hang, and
// what lies elsewhere is not the scene's to read.
class FencedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit FencedFiles(const fs::path& file) {
    std::error_code error;
    folder_ = fs::canonical(fs::absolute(file, error).parent_path(), error);
  }

  bool Exists(const char* name) const override {
    const std::string file = FindNamed(name);
    return IsAllowed(file) && DefaultIOSystem::Exists(file.c_str());
  }
  Assimp::IOStream* Open(const char* name, const char* mode = "rb") override {
    const std::string file = FindNamed(name);
    if (IsAllowed(file)) return DefaultIOSystem::Open(file.c_str(), mode);
    refused_ = name;
    return nullptr;
  }
  /// The last file that was asked for and is not allowed; empty for none.
  const std::string& refused() const { return refused_; }

 private:
  // In glTF a file's name is a URI, in which a blank is %20; assimp passes it on as it is.
  static std::string FindNamed(const std::string& name) {
    std::error_code error;
    if (fs::exists(name, error)) return name;
    std::string decoded;
    for (std::size_t i = 0; i < name.size(); ++i) {
      unsigned char byte = 0;
      const char* digits = name.data() + i + 1;
      const bool is_code = name[i] == '%' && i + 2 < name.size() &&
                           std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
      decoded += is_code ? static_cast<char>(byte) : name[i];
      if (is_code) i += 2;
    }
    return decoded.find('\0') == std::string::npos ? decoded : name;
  }

  bool IsAllowed(const std::string& name) const {
    std::error_code error;
    const fs::path real = fs::canonical(name, error);
    if (error || !fs::is_regular_file(real, error)) return false;
    if (fs::file_size(real, error) > kMaxBytes || error) return false;
    const auto [rest, end] =
        std::mismatch(folder_.begin(), folder_.end(), real.begin(), real.end());
    return !folder_.empty() && rest == folder_.end();
  }

  fs::path folder_;
  std::string refused_;
};

// The importer owns the scene that it returns. Materials, textures and normals are left out: their
// loss lets equal positions be one vertex.
const aiScene* Import(Assimp::Importer& importer, const fs::path& file) {
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_LINE | aiPrimitiveType_POINT);
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  // The file's own frame, as of every other format; assimp would turn it until y is up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  auto* files = new FencedFiles(file);  // the importer's from the next line on
  importer.SetIOHandler(files);
  std::string problem;
  try {
    const aiScene* scene = importer.ReadFile(
        file.string(), aiProcess_ValidateDataStructure | aiProcess_RemoveComponent |
                           aiProcess_Triangulate | aiProcess_SortByPType |
                           aiProcess_PreTransformVertices);
    if (scene != nullptr) return scene;
    problem = importer.GetErrorString();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (!files->refused().empty()) {
    throw UnreadableFile("a mesh whose other files are plain files in its own folder",
                         "which names \"" + files->refused() + '"');
  }
  throw UnreadableFile("a mesh that assimp can read",
                       problem.empty() ? "which it cannot" : "of which it says: " + problem);
}

std::string ReadBytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// What a reader of ours makes of a file's bytes. @param kind  "a PLY file".
template <typename Parse>
auto ParseAs(const std::string& kind, const std::string& bytes, const Parse& parse) {
  try {
    return parse(bytes);
  } catch (const std::runtime_error& error) {
    throw UnreadableFile(kind, std::string("which ") + error.what());
  }
}

PlyContent ReadPly(const fs::path& file) {
  return ParseAs("a PLY file", ReadBytes(file), ParsePly);
}

void RequireTriangles(std::size_t count) {
  if (count == 0) throw UnreadableFile("a mesh with triangles", "which has none");
  if (count > kMaxTriangles) {
    throw UnreadableFile(fmt::format("at most {} triangles", kMaxTriangles),
                         fmt::format("which has {}", count));
  }
}

TriangleMesh ReadPlyTriangles(const fs::path& file) {
  PlyContent content = ReadPly(file);
  RequireTriangles(static_cast<std::size_t>(content.F.rows()));
  return {std::move(content.V), std::move(content.F)};
}

TriangleMesh WithTriangles(TriangleMesh mesh) {
  RequireTriangles(static_cast<std::size_t>(mesh.F.rows()));
  return mesh;
}

TriangleMesh ImportTriangles(const fs::path& file) {
  Assimp::Importer importer;
  const aiScene* scene = Import(importer, file);
  std::size_t vertices = 0, triangles = 0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    vertices += scene->mMeshes[m]->mNumVertices;
    triangles += scene->mMeshes[m]->mNumFaces;
  }
  RequireTriangles(triangles);
  TriangleMesh result;
  result.V.resize(static_cast<int>(vertices), 3);
  result.F.resize(static_cast<int>(triangles), 3);
  int v = 0, f = 0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    const int first = v;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      result.V.row(v++) << p.x, p.y, p.z;
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines of a mixed mesh
      for (int k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) {
          throw UnreadableFile("faces that name vertices of the file", "in which one does not");
        }
        result.F(f, k) = first + static_cast<int>(face.mIndices[k]);
      }
      ++f;
    }
  }
  result.F.conservativeResize(f, 3);
  RequireTriangles(static_cast<std::size_t>(f));
  return result;
}

}  // namespace

TriangleMesh ReadTriangles(const fs::path& file) {
  RequireReadable(file);
  const std::string extension = Extension(file);
  if (extension == ".ply") return ReadPlyTriangles(file);
  if (extension == ".off") {
    return WithTriangles(ParseAs("an OFF file", ReadBytes(file), ParseOff));
  }
  if (extension == ".stl") {
    const std::string bytes = ReadBytes(file);
    if (IsTextStl(bytes)) return WithTriangles(ParseAs("an STL file", bytes, ParseTextStl));
  }
  return ReadInChild([&] { return ImportTriangles(file); });
}

PointFile ReadPoints(const fs::path& file) {
  RequireReadable(file);
  if (Extension(file) != ".ply") throw UnreadableFile("a cloud in a .ply file", "");
  PlyContent content = ReadPly(file);
  if (content.V.rows() == 0) throw UnreadableFile("a cloud with points", "which has none");
  constexpr int kMaxPoints = 2'000'000;
  if (content.V.rows() > kMaxPoints) {
    throw UnreadableFile(fmt::format("at most {} points", kMaxPoints),
                         fmt::format("which has {}", content.V.rows()));
  }
  return {std::move(content.V), std::move(content.N)};
}

}  // namespace pregrasp
