#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Bits per component (positions and uvs: of the box they fill). 16 bits of position are 1/65,535 of the box's longest
/// side.
struct DracoQuantisation {
  int position_bits = 16;
  int uv_bits = 16;
  int normal_bits = 12;
};  // colors have 8, the steps of 1/255

/// Writes positions, in the file's units from the origin of the mesh's frame, and, where the mesh has them, normals,
/// uvs and colors. The origin goes into the file's metadata, as the entry `kiln-origin` of three doubles. Vertices keep
/// being split where they were; their order and that of the triangles may change, so whoever measures the result loads
/// it again.
void save_draco(const std::filesystem::path& file, const TriangleMesh& mesh,
                const DracoQuantisation& quantisation = {});

/// Whole numbers at every vertex, which a Draco file keeps exactly: a generic attribute of unsigned integers. Consumers
/// find it by the entry `name` of its metadata, or by its unique id.
struct IntegerAttribute {
  std::string name;
  int components = 1;                 ///< 1 to 4, so that it fits a shader's attribute
  int bits = 8;                       ///< 8 or 16 of a component
  std::vector<std::uint16_t> values;  ///< vertex * components + component; below 2^bits
  std::uint32_t unique_id = 0;        ///< in the file: set by load_attributed_draco
};

struct AttributedMesh {
  TriangleMesh mesh;
  std::vector<IntegerAttribute> attributes;
};

/// save_draco with further attributes. Gives, for every vertex of the file in its order there, which vertex of `mesh`
/// it was. A vertex where sheets of surface touch may be there more than once; one without a proper triangle is left
/// out.
std::vector<std::uint32_t> save_attributed_draco(const std::filesystem::path& file, const TriangleMesh& mesh,
                                                 const std::vector<IntegerAttribute>& attributes,
                                                 const DracoQuantisation& quantisation = {});

/// Reads what save_attributed_draco wrote; attributes in the order they were given. Throws BadInput for anything else.
AttributedMesh load_attributed_draco(const std::filesystem::path& file);

/// Whether a file is Draco by its extension, in any case of letters.
bool is_draco_file(const std::filesystem::path& file);

/// Reads what save_draco wrote, vertices and triangles as they are in the file, in their frame. Throws BadInput for
/// anything else.
TriangleMesh load_draco(const std::filesystem::path& file);

/// load_draco for an atlas: throws BadInput where the mesh has no uvs or one of them lies outside the unit square.
TriangleMesh load_atlas(const std::filesystem::path& file);

}  // namespace kiln
