// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Bits per component; positions and uvs are quantised over the box that they fill. 16 bits of position are steps of
/// 1/65,535 of the box's longest side.
struct DracoQuantisation {
  int position_bits = 16;
  int uv_bits = 16;
  int texture_uv_bits = 16;
  int normal_bits = 12;
};  // colors always get 8 bits, steps of 1/255

/// Returns the bits of uvs whose steps are at most 1/65,535 of the unit square: 16, or more where they fill a larger
/// box; 24 at most.
int sufficient_uv_bits(const std::vector<Eigen::Vector2f>& uvs);

/// Writes positions (in the file's units, relative to the origin of the mesh's frame) and, where the mesh has them,
/// normals, uvs, texture uvs (a second set of texture coordinates) and colors. The origin goes into the file's
/// metadata, as the entry `kiln-origin` of three doubles. Split vertices stay split, but the order of vertices and
/// triangles may change, so load the file again to measure the result.
void save_draco(const std::filesystem::path& file, const TriangleMesh& mesh,
                const DracoQuantisation& quantisation = {});

/// Integer values at every vertex, which a Draco file keeps exactly: a generic attribute of unsigned integers.
/// Consumers find it by the entry `name` of its metadata, or by its unique id.
struct IntegerAttribute {
  std::string name;
  int components = 1;                 ///< components per vertex, 1 to 4, so that they fit a shader's attribute
  int bits = 8;                       ///< bits of a component: 8 or 16
  std::vector<std::uint16_t> values;  ///< vertex * components + component; below 2^bits
  std::uint32_t unique_id = 0;        ///< id in the file, set by load_attributed_draco
};

struct AttributedMesh {
  TriangleMesh mesh;
  std::vector<IntegerAttribute> attributes;
};

/// Writes as save_draco does, with further attributes. Returns, for every vertex of the file in its order, the vertex
/// of `mesh` that it was. A vertex where sheets touch may appear more than once; one without a proper triangle is left
/// out.
std::vector<std::uint32_t> save_attributed_draco(const std::filesystem::path& file, const TriangleMesh& mesh,
                                                 const std::vector<IntegerAttribute>& attributes,
                                                 const DracoQuantisation& quantisation = {});

/// Reads what save_attributed_draco wrote, attributes in their order. Throws BadInput for anything else.
AttributedMesh load_attributed_draco(const std::filesystem::path& file);

/// Tells whether a file is Draco by its extension, in any case of letters.
bool is_draco_file(const std::filesystem::path& file);

/// Reads what save_draco wrote, with vertices, triangles and frame as the file has them. Throws BadInput for anything
/// else.
TriangleMesh load_draco(const std::filesystem::path& file);

/// Reads an atlas as load_draco does; throws BadInput where the mesh has no uvs or one of them lies outside the unit
/// square.
TriangleMesh load_atlas(const std::filesystem::path& file);

}  // namespace kiln
