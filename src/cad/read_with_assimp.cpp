#include <assimp/scene.h>

#include <Eigen/LU>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {
namespace {

Eigen::Matrix4d to_double(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column) result(row, column) = double(m[row][column]);
  return result;
}

void append_mesh(const aiMesh& mesh, const Eigen::Matrix4d& transform, PolygonSoup& soup) {
  const auto first = static_cast<std::uint32_t>(soup.points.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& v = mesh.mVertices[i];
    const Eigen::Vector4d moved = transform * Eigen::Vector4d(v.x, v.y, v.z, 1.0);
    soup.points.emplace_back(moved.head<3>());
  }
  const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices < 3) continue;  // a point or a line is no part of a wall
    std::vector<std::uint32_t>& polygon = soup.polygons.emplace_back();
    polygon.reserve(face.mNumIndices);
    for (unsigned k = 0; k < face.mNumIndices; ++k) polygon.push_back(first + face.mIndices[k]);
    if (mirrored) std::reverse(polygon.begin(), polygon.end());
  }
}

void append_node(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent, PolygonSoup& soup) {
  const Eigen::Matrix4d transform = parent * to_double(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    append_mesh(*scene.mMeshes[node.mMeshes[i]], transform, soup);
  for (unsigned i = 0; i < node.mNumChildren; ++i) append_node(scene, *node.mChildren[i], transform, soup);
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
  append_node(*scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), result.soup);
  const auto finite = [](const Vector<3>& p) { return p.allFinite(); };
  const auto valid = [&](const std::vector<std::uint32_t>& polygon) {
    return *std::max_element(polygon.begin(), polygon.end()) < result.soup.points.size();
  };
  if (!std::all_of(result.soup.points.begin(), result.soup.points.end(), finite)) {
    result.failure = "a coordinate is not finite";
  } else if (!std::all_of(result.soup.polygons.begin(), result.soup.polygons.end(), valid)) {
    result.failure = "a face names a vertex that does not exist";
  }
  return result;
}

}  // namespace

// No post-processing: assimp's welding has an absolute tolerance, and its triangulation knows only floats.
ReadAttempt read_with_assimp(const std::filesystem::path& file) {
  Assimp::Importer importer;
  return attempt(importer, importer.ReadFile(file.string(), 0));
}

ReadAttempt read_stl_with_assimp(const std::string& content) {
  Assimp::Importer importer;
  return attempt(importer, importer.ReadFileFromMemory(content.data(), content.size(), 0, "stl"));
}

}  // namespace bernal::cad
