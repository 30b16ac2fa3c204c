// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "import/coordinates.h"
#include "import/off_colors.h"
#include "import/off_header.h"
#include "import/source_mesh.h"

namespace kiln {

/// Mesh of an OFF file as it grows, vertex by vertex and face by face.
class OffMesh {
 public:
  /// Begins a mesh. The rest of the file, after the header, has `byte_count` bytes. Counts in `header` are what the
  /// file claims.
  OffMesh(const std::filesystem::path& file, const OffHeader& header, std::size_t byte_count);

  /// Returns the least number of numbers of a vertex: its position, its weight and its normal.
  std::size_t place_size() const;

  /// Adds a vertex of these numbers.
  void add_vertex(std::span<const double> numbers);
  void add_uv(double u, double v);

  /// Begins a face; `line` is 0 in binary files, `room` the largest number of corners that fits into the rest of the
  /// file. Throws BadInput for fewer than three corners and for more than `room`.
  void begin_face(double corner_count, std::size_t room, std::uint32_t line);
  void add_corner(double index);

  /// Returns "vertex 5 of 8" for the next one; the function below "face 5 of 8" for the last one begun.
  std::string next_vertex_name() const;
  std::string face_name(std::size_t face) const;
  std::size_t vertex_count() const { return mesh_.places.size(); }
  std::size_t face_count() const { return mesh_.faces.size(); }
  [[noreturn]] void throw_truncated(const std::string& name) const;

  /// Counts a face colour of one number, an index into a colour map that is not in the file.
  void add_mapped_color() { ++mapped_colors_; }

  /// Returns the whole mesh, checked, with its colours.
  SourceMesh take();

  OffColors vertex_colors, face_colors;
  OffColorScale color_scale;
  TextPrecision text_precision;
  std::vector<std::string> warnings;

 private:
  std::string where() const;
  void take_colors();

  const std::filesystem::path path_;
  const std::string file_;
  const OffHeader header_;
  SourceMesh mesh_;
  std::uint64_t mapped_colors_ = 0;
};

}  // namespace kiln
