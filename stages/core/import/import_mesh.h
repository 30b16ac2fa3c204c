// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/import_settings.h"
#include "import/source_mesh.h"
#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Surface attributes from a mesh file, for the triangles made of it.
struct ImportedSurface {
  /// Face without texture coordinates.
  struct FaceWithoutUvs {
    bool found = false;
    std::uint32_t line = 0;  ///< line in a text file, from 1; else 0
    std::uint32_t face = 0;  ///< from 1
  };

  std::vector<SourceMaterial> materials;
  std::vector<std::int32_t> material_of;            ///< per triangle, -1 for none; empty where no face has one
  std::vector<std::string> parts;                   ///< names of the file's parts; none where it names none
  std::vector<std::int32_t> part_of;                ///< per triangle, -1 for none; empty where `parts` is
  std::vector<std::array<Eigen::Vector2f, 3>> uvs;  ///< per triangle's corners; empty where the file has none
  std::vector<FaceWithoutUvs> without_uvs;          ///< per material; the last entry is for faces without one
  std::optional<BadInput> materials_fault;          ///< reason why the file's materials cannot be used
  bool linear_colors = false;                       ///< the mesh's colours are proportional to light
};

/// Mesh file as all stages see it.
struct ImportedMesh {
  std::filesystem::path file;
  TriangleMesh mesh;  ///< repaired, with normals, in its frame
  ImportedSurface surface;
  MeshRepairs repairs;
  std::vector<std::filesystem::path> further_files;  ///< files that were read besides
  std::vector<std::string> warnings;                 ///< parts of the file that are not used, and unrequested repairs
};

/// Reads a high mesh of any format that read_source_mesh knows. Coordinates are turned and scaled as `settings` say,
/// polygons triangulated, borders welded, and the mesh repaired (repair_mesh), so that every stage sees the same
/// oriented manifold. Normals are the file's, or computed from the faces; materials, uvs and normals follow triangles
/// through repair. The mesh is moved and scaled into `frame`, or into a frame of its own if float32 could not hold it
/// otherwise. Throws BadInput for what cannot be read, for a mesh without area, and where `settings` ask for the file's
/// normals and it has none.
ImportedMesh import_mesh(const std::filesystem::path& file, const ImportSettings& settings = {},
                         const std::optional<MeshFrame>& frame = std::nullopt);

/// Low mesh and the cage that an artist made for it.
struct CagedMesh {
  ImportedMesh low;
  /// Offsets from the corners of each triangle of the low mesh to their places in the cage.
  std::vector<std::array<Eigen::Vector3f, 3>> offsets;
  std::vector<std::filesystem::path> files;  ///< the cage's, and what it names
};

/// Reads a mesh as import_mesh does, and its cage: a mesh of any format that has the same faces in the same order, each
/// of as many corners in the same order, which `settings` turn and scale likewise. Throws BadInput, which names the
/// cage, where faces or corners are not as many.
CagedMesh import_caged_mesh(const std::filesystem::path& file, const std::filesystem::path& cage,
                            const ImportSettings& settings, const std::optional<MeshFrame>& frame = std::nullopt);

/// Returns the mesh of import_mesh alone.
TriangleMesh load_mesh(const std::filesystem::path& file, MeshRepairs* repairs = nullptr,
                       const ImportSettings& settings = {});

/// Returns the frame of a mesh that fills this box of a file: the identity where float32 holds its positions to a few
/// millionths of its size.
MeshFrame frame_of(const Eigen::Vector3d& lowest, const Eigen::Vector3d& highest);

}  // namespace kiln
