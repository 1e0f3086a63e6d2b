#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <fmt/format.h>

#include <assimp/BaseImporter.h>
#include <Eigen/LU>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <iterator>
#include <sstream>

#include "cad/read/caged_reader.hpp"
#include "cad/read/file_facts.hpp"
#include "cad/read/files_of_part.hpp"
#include "cad/read/known_formats.hpp"
#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {
namespace {

/// Limits for one file: more indicates an error or an attack.
constexpr std::size_t most_corners = 3'000'000'000U;
constexpr int most_nested_nodes = 1000;

/// Opens only regular files in the part's folder or below, and for glTF only those that its digest covers.
class FilesBeside : public Assimp::DefaultIOSystem {
 public:
  explicit FilesBeside(const std::filesystem::path& file)
      : beside_(file.parent_path().string()),
        folder_(std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path())) {
    if (const std::string extension = extension_of(file); extension == ".gltf" || extension == ".glb")
      for (const std::filesystem::path& part : files_of_part(file))
        only_.push_back(std::filesystem::weakly_canonical(std::filesystem::absolute(part)));
  }

  bool Exists(const char* name) const override { return allowed(name) || allowed(decoded(name)); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (mode[0] != 'r') return nullptr;
    if (allowed(name)) return DefaultIOSystem::Open(name, mode);
    const std::string file = decoded(name);
    return allowed(file) ? DefaultIOSystem::Open(file.c_str(), mode) : nullptr;
  }

 private:
  /// The name below the part's folder with its URI escapes decoded.
  std::string decoded(std::string_view name) const {
    if (!name.starts_with(beside_)) return std::string(name);
    return beside_ + percent_decoded(name.substr(beside_.size()));
  }

  bool allowed(const std::filesystem::path& name) const {
    std::error_code unknown;
    const auto file = std::filesystem::canonical(std::filesystem::absolute(name), unknown);
    if (unknown || !std::filesystem::is_regular_file(file, unknown)) return false;
    if (!only_.empty() && std::ranges::find(only_, file) == only_.end()) return false;
    return std::mismatch(folder_.begin(), folder_.end(), file.begin(), file.end()).first == folder_.end();
  }

  std::string beside_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> only_;  ///< empty: no restriction
};

/// An error of the file as a whole.
struct Refused {
  std::string_view why;
};

Eigen::Matrix4d to_double(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column) result(row, column) = double(m[row][column]);
  return result;
}

/// Throws Refused.
void append_mesh(const aiMesh& mesh, const Eigen::Matrix4d& transform, PolygonSoup& soup) {
  const auto first = static_cast<std::uint32_t>(soup.points.size());
  if (soup.points.size() + mesh.mNumVertices > most_corners) throw Refused{"it has more than 3e9 corners"};
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& v = mesh.mVertices[i];
    const Eigen::Vector4d moved = transform * Eigen::Vector4d(v.x, v.y, v.z, 1.0);
    soup.points.emplace_back(moved.head<3>());
  }
  const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices < 3) continue;  // points and lines are not walls
    std::vector<std::uint32_t>& polygon = soup.polygons.emplace_back();
    polygon.reserve(face.mNumIndices);
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) throw Refused{"a face names a vertex that does not exist"};
      polygon.push_back(first + face.mIndices[k]);
    }
    if (mirrored) std::reverse(polygon.begin(), polygon.end());
  }
}

/// `above` includes the transform of the node itself. A transform that flattens a node hides it, which
/// exporters do on purpose.
void append_node(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& above, PolygonSoup& soup,
                 int level = 0) {
  if (level == most_nested_nodes) throw Refused{"its parts are nested more than a thousand deep"};
  const std::size_t first = soup.polygons.size();
  const bool hidden = above.topLeftCorner<3, 3>().determinant() == 0;
  for (unsigned i = 0; i < node.mNumMeshes && !hidden; ++i)
    append_mesh(*scene.mMeshes[node.mMeshes[i]], above, soup);
  if (soup.polygons.size() > first) soup.solids.push_back({node.mName.C_Str(), first});
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    const aiNode& child = *node.mChildren[i];
    append_node(scene, child, above * to_double(child.mTransformation), soup, level + 1);
  }
}

std::string format_of(const aiScene& scene) {
  aiString format;
  if (scene.mMetaData != nullptr) scene.mMetaData->Get("SourceAsset_Format", format);
  return format.C_Str();
}

/// Centimetres by the specification, times the factor in the file.
FileFacts facts_of_fbx(const aiScene& scene) {
  FileFacts facts;
  double factor = 0;
  float single = 0;
  if (!scene.mMetaData->Get("UnitScaleFactor", factor) && scene.mMetaData->Get("UnitScaleFactor", single))
    factor = double(single);
  // Most exporters store the factor in single precision.
  for (const auto& [exact, name] :
       {std::pair{0.1, "millimeter"}, {1.0, "centimeter"}, {100.0, "meter"}, {2.54, "inch"}, {30.48, "foot"}})
    if (std::abs(factor - exact) < 1e-6 * exact) facts.unit = FileFacts::Length{exact / 100, name};
  if (!facts.unit && factor > 0 && std::isfinite(factor))
    facts.unit = FileFacts::Length{factor / 100, fmt::format("{} cm", factor)};
  std::int32_t axis = -1;
  if (scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis <= 2) facts.up = "xyz"[axis];
  return facts;
}

/// The unit and axes that the file states.
void add_facts(const std::filesystem::path& file, const aiScene& scene, ReadAttempt& result) {
  const std::string format = format_of(scene);
  if (format.starts_with("Collada")) {
    result.facts = facts_of_collada(text_without_mark(file));
  } else if (format.starts_with("glTF")) {
    result.facts.unit = FileFacts::Length{1, "meter"};
  } else if (format.starts_with("Autodesk FBX")) {
    result.facts = facts_of_fbx(scene);
  }
}

/// Drops a single part without a name, and names that assimp made up.
void drop_single_nameless(std::vector<Solid>& solids) {
  for (Solid& solid : solids)
    if (solid.name.starts_with("$ColladaAutoName$")) solid.name.clear();
  if (solids.size() == 1 && solids.front().name.empty()) solids.clear();
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text.empty() ? "no reason given" : text;
}

ReadAttempt attempt(const Assimp::Importer& importer, const aiScene* scene) {
  ReadAttempt result;
  if (scene == nullptr || scene->mRootNode == nullptr) {
    result.failure = one_line(importer.GetErrorString());
    return result;
  }
  // assimp puts its own rotation and scaling to y-up and metres into the root's transform, which has no other
  // content: for Collada, and since 5.3 for FBX.
  const std::string format = format_of(*scene);
  const bool turned = format.starts_with("Collada") || format.starts_with("Autodesk FBX");
  const aiMatrix4x4 root = turned ? aiMatrix4x4() : scene->mRootNode->mTransformation;
  try {
    append_node(*scene, *scene->mRootNode, to_double(root), result.soup);
  } catch (const Refused& refused) {
    result.failure = refused.why;
  }
  const auto finite = [](const Vector<3>& p) { return p.allFinite(); };
  if (!std::all_of(result.soup.points.begin(), result.soup.points.end(), finite))
    result.failure = "a coordinate is not finite";
  return result;
}

/// Keeps only the importers of the extension: content alone may match an untested format.
void keep_importers_of(const std::string& extension, Assimp::Importer& importer) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    std::istringstream known(importer.GetImporterInfo(i)->mFileExtensions);
    const std::vector<std::string> extensions(std::istream_iterator<std::string>(known), {});
    if (std::ranges::find(extensions, extension) == extensions.end())
      others.push_back(importer.GetImporter(i));
  }
  for (Assimp::BaseImporter* other : others) {
    importer.UnregisterLoader(other);
    delete other;
  }
}

/// No post-processing: assimp's welding has an absolute tolerance, and its triangulation knows only floats.
ReadAttempt read_here(const std::filesystem::path& file) {
  const std::string extension = extension_of(file).substr(1);
  Assimp::Importer importer;
  keep_importers_of(extension, importer);
  importer.SetIOHandler(new FilesBeside(file));                                // takes ownership
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);  // otherwise they are ids
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ReadAttempt result = attempt(importer, scene);
  if (result.ok()) add_facts(file, *scene, result);
  drop_single_nameless(result.soup.solids);
  return result;
}

}  // namespace

ReadAttempt read_with_assimp(const std::filesystem::path& file) {
  ReadAttempt result =
      read_in_cage("assimp", cage_limits(std::filesystem::file_size(file)), [&] { return read_here(file); });
  result.reader = "assimp, single precision";
  return result;
}

}  // namespace bernal::cad
