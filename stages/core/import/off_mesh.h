#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "import/coordinates.h"
#include "import/off_colors.h"
#include "import/off_header.h"
#include "import/source_mesh.h"

namespace kiln {

/// The mesh of an OFF file as it grows, vertex by vertex and face by face.
class OffMesh {
 public:
  /// The rest of the file, behind the header, has `byte_count` bytes. Counts in `header` are what the file says.
  OffMesh(const std::filesystem::path& file, const OffHeader& header, std::size_t byte_count);

  /// How many numbers a vertex has at least: its place, its weight and its normal.
  std::size_t place_size() const;

  /// Adds a vertex of so many numbers.
  void add_vertex(std::span<const double> numbers);
  void add_uv(double u, double v);

  /// Begins a face; `line` is 0 in binary files, `room` is how many corners the rest of the file has room for. Throws
  /// BadInput for fewer than three corners and for more than there is room for.
  void begin_face(double corner_count, std::size_t room, std::uint32_t line);
  void add_corner(double index);

  /// "vertex 5 of 8", the next to come; "face 5 of 8", the last that was begun.
  std::string next_vertex_name() const;
  std::string face_name(std::size_t face) const;
  std::size_t vertex_count() const { return mesh_.places.size(); }
  std::size_t face_count() const { return mesh_.faces.size(); }
  [[noreturn]] void throw_truncated(const std::string& name) const;

  /// Adds a face's colour of one number, an index into a map of colours that is not in the file.
  void add_mapped_color() { ++mapped_colors_; }

  /// The whole mesh, checked, with its colours at their places.
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
