#include "mesh/mesh_file.h"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/IO/read_ply_points.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Simple_cartesian.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include "base/errors.h"
#include "base/outputs.h"
#include "mesh/draco_file.h"

namespace kiln {

namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Polygon = std::vector<std::size_t>;

constexpr char expected_mesh[] = "a mesh of triangles or polygons";
constexpr char remedy_export[] = "export the mesh again";

struct Soup {
  std::vector<Point> points;
  std::vector<Polygon> polygons;
  std::vector<Eigen::Vector3f> colors;  ///< as many as points, or none
};

std::vector<Eigen::Vector3f> from_bytes(const std::vector<CGAL::IO::Color>& bytes) {
  std::vector<Eigen::Vector3f> colors;
  colors.reserve(bytes.size());
  for (const CGAL::IO::Color& color : bytes)
    colors.push_back(Eigen::Vector3f(color.red(), color.green(), color.blue()) / 255);
  return colors;
}

/// The colours in lines "v x y z r g b", where every such line has them.
std::vector<Eigen::Vector3f> read_obj_colors(const std::string& file) {
  std::vector<Eigen::Vector3f> colors;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("v ", 0) != 0 && line.rfind("v\t", 0) != 0) continue;
    std::istringstream words(line.substr(2));
    Eigen::Vector3f place, color;
    words >> place.x() >> place.y() >> place.z() >> color.x() >> color.y() >> color.z();
    if (!words) return {};
    colors.push_back(color);
  }
  return colors;
}

/// Whether the vertices of a PLY file have red, green and blue as floats, which CGAL's reader of meshes passes by.
bool has_float_colors(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::set<std::string> found;
  std::string element;
  for (std::string line; std::getline(stream, line) && line.rfind("end_header", 0) != 0;) {
    std::istringstream words(line);
    std::string kind, first, second;
    words >> kind >> first >> second;
    if (kind == "element") element = first;
    if (kind == "property" && element == "vertex" && (first == "float" || first == "float32")) found.insert(second);
  }
  return found.contains("red") && found.contains("green") && found.contains("blue");
}

std::vector<Eigen::Vector3f> read_ply_float_colors(const std::string& file) {
  using Vertex = std::tuple<Point, float, float, float>;
  std::vector<Vertex> vertices;
  std::ifstream stream(file, std::ios::binary);
  if (!CGAL::IO::read_PLY_with_properties(
          stream, std::back_inserter(vertices),
          CGAL::IO::make_ply_point_reader(CGAL::Nth_of_tuple_property_map<0, Vertex>()),
          std::make_pair(CGAL::Nth_of_tuple_property_map<1, Vertex>(), CGAL::IO::PLY_property<float>("red")),
          std::make_pair(CGAL::Nth_of_tuple_property_map<2, Vertex>(), CGAL::IO::PLY_property<float>("green")),
          std::make_pair(CGAL::Nth_of_tuple_property_map<3, Vertex>(), CGAL::IO::PLY_property<float>("blue"))))
    return {};
  std::vector<Eigen::Vector3f> colors;
  for (const auto& [place, red, green, blue] : vertices) colors.emplace_back(red, green, blue);
  return colors;
}

Soup read_soup(const std::filesystem::path& file, const std::string& extension) {
  Soup soup;
  const std::string name = file.string();
  std::vector<CGAL::IO::Color> colors, face_colors;
  const auto quiet = CGAL::parameters::verbose(false);
  const auto colored = quiet.vertex_color_output_iterator(std::back_inserter(colors))
                           .face_color_output_iterator(std::back_inserter(face_colors));  // read_PLY wants both
  bool whole = false;
  try {
    if (extension == ".obj") whole = CGAL::IO::read_OBJ(name, soup.points, soup.polygons, quiet);
    if (extension == ".off") whole = CGAL::IO::read_OFF(name, soup.points, soup.polygons, colored);
    if (extension == ".stl") whole = CGAL::IO::read_STL(name, soup.points, soup.polygons, quiet);
    if (extension == ".ply") whole = CGAL::IO::read_PLY(name, soup.points, soup.polygons, colored);
    if (whole) {
      soup.colors = from_bytes(colors);
      if (extension == ".obj") soup.colors = read_obj_colors(name);
      if (extension == ".ply" && has_float_colors(name)) soup.colors = read_ply_float_colors(name);
    }
  } catch (const std::exception& error) {
    throw BadInput(name, std::string("cannot be understood (") + error.what() + ")", expected_mesh, remedy_export);
  }
  if (!whole)
    throw BadInput(name, "is truncated or damaged", "a whole " + extension.substr(1) + " file", remedy_export);
  if (soup.colors.size() != soup.points.size()) soup.colors.clear();
  return soup;
}

void check_soup(const std::string& name, const Soup& soup) {
  if (soup.polygons.empty()) throw BadInput(name, "has no faces", expected_mesh, remedy_export);
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const Point& p = soup.points[i];
    const bool fits = std::abs(p.x()) < 1e30 && std::abs(p.y()) < 1e30 && std::abs(p.z()) < 1e30;  // false for NaN, too
    if (!fits)
      throw BadInput(name, "vertex " + std::to_string(i + 1) + " has a coordinate that is not a finite number",
                     "finite coordinates below 1e30", remedy_export);
  }
  for (std::size_t i = 0; i < soup.polygons.size(); ++i) {
    const auto where = [&] { return "face " + std::to_string(i + 1); };
    if (soup.polygons[i].size() < 3)
      throw BadInput(name, where() + " has fewer than three corners", "a whole file", remedy_export);
    for (std::size_t vertex : soup.polygons[i])
      if (vertex >= soup.points.size())
        throw BadInput(
            name,
            where() + " refers to vertex " + std::to_string(vertex + 1) + " of " + std::to_string(soup.points.size()),
            "a whole file", remedy_export);
  }
}

/// Quads are cut along the shorter diagonal of those that keep both halves on the same side; polygons of more corners
/// by CGAL's triangulation of least area.
void triangulate(const Soup& soup, std::vector<Triangle>& triangles, MeshRepairs& repairs) {
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  };
  for (const Polygon& polygon : soup.polygons) {
    if (polygon.size() > 3) ++repairs.triangulated_polygons;
    std::size_t first = 0;
    if (polygon.size() == 4) {
      const auto at = [&](int i) { return soup.points[polygon[static_cast<std::size_t>(i % 4)]]; };
      const auto folds = [&](int i) {  // at the diagonal from corner i
        return CGAL::scalar_product(CGAL::cross_product(at(i + 1) - at(i), at(i + 2) - at(i)),
                                    CGAL::cross_product(at(i + 2) - at(i), at(i + 3) - at(i))) < 0;
      };
      const bool first_shorter = CGAL::squared_distance(at(0), at(2)) <= CGAL::squared_distance(at(1), at(3));
      first = folds(0) != folds(1) ? folds(0) : !first_shorter;
    }
    if (polygon.size() > 4) {
      using Face = CGAL::Triple<int, int, int>;
      std::vector<Point> corners;
      for (const std::size_t vertex : polygon) corners.push_back(soup.points[vertex]);
      std::vector<Face> faces;
      CGAL::Polygon_mesh_processing::triangulate_hole_polyline(corners, std::back_inserter(faces));
      for (const Face& face : faces)
        add(polygon[static_cast<std::size_t>(face.first)], polygon[static_cast<std::size_t>(face.second)],
            polygon[static_cast<std::size_t>(face.third)]);
      if (!faces.empty()) continue;
    }
    const auto corner = [&](std::size_t i) { return polygon[(first + i) % polygon.size()]; };
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) add(corner(0), corner(i), corner(i + 1));
  }
}

/// The vertices that triangles use, in the order in which they do.
TriangleMesh to_mesh(const Soup& soup, const std::vector<Triangle>& triangles) {
  TriangleMesh mesh;
  mesh.triangles = triangles;
  constexpr std::uint32_t unseen = ~0u;
  std::vector<std::uint32_t> new_index(soup.points.size(), unseen);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) {
      if (new_index[vertex] == unseen) {
        new_index[vertex] = static_cast<std::uint32_t>(mesh.positions.size());
        const Point& p = soup.points[vertex];
        mesh.positions.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
        if (!soup.colors.empty()) mesh.colors.push_back(soup.colors[vertex]);
      }
      vertex = new_index[vertex];
    }
  return mesh;
}

/// Brings colours to 0 to 1; returns how many lay outside.
int clamp_colors(const std::string& name, std::vector<Eigen::Vector3f>& colors) {
  int clamped = 0;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (!colors[i].allFinite())
      throw BadInput(name, "a colour of a vertex that is not a finite number", "red, green and blue of 0 to 1",
                     remedy_export);
    const Eigen::Vector3f inside = colors[i].cwiseMax(0).cwiseMin(1);
    clamped += inside != colors[i];
    colors[i] = inside;
  }
  return clamped;
}

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& file, MeshRepairs* repairs_out,
                       const MeshRepairSettings& settings) {
  const std::string name = file.string();
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  static const std::set<std::string> known = {".obj", ".off", ".stl", ".ply", ".drc"};
  if (!known.contains(extension))
    throw BadInput(name, "has the unknown extension '" + extension + "'", "obj, ply, stl, off or drc",
                   "convert the mesh");

  MeshRepairs read;
  TriangleMesh mesh;
  if (extension == ".drc") {
    mesh = load_draco(file);
  } else {
    if (read_text(file).empty()) throw BadInput(name, "is empty", expected_mesh, remedy_export);
    const Soup soup = read_soup(file, extension);
    check_soup(name, soup);
    std::vector<Triangle> triangles;
    triangulate(soup, triangles, read);
    mesh = to_mesh(soup, triangles);
    read.unused_vertices = static_cast<int>(soup.points.size() - mesh.positions.size());
  }

  const int clamped_colors = clamp_colors(name, mesh.colors);
  MeshRepairs repairs = repair_mesh(mesh, settings);
  repairs.clamped_colors = clamped_colors;
  if (mesh.triangles.empty()) throw BadInput(name, "has no triangle with an area", expected_mesh, remedy_export);
  if (extension == ".stl") repairs.merged_vertices = 0;  // the format has each vertex once a triangle
  repairs.triangulated_polygons = read.triangulated_polygons;
  repairs.unused_vertices += read.unused_vertices;
  compute_vertex_normals(mesh);
  if (repairs_out != nullptr) *repairs_out = repairs;
  return mesh;
}

}  // namespace kiln
