#include "mesh/mesh_file.h"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

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
};

Soup read_soup(const std::filesystem::path& file, const std::string& extension) {
  Soup soup;
  const std::string name = file.string();
  const auto quiet = CGAL::parameters::verbose(false);
  bool whole = false;
  try {
    if (extension == ".obj") whole = CGAL::IO::read_OBJ(name, soup.points, soup.polygons, quiet);
    if (extension == ".off") whole = CGAL::IO::read_OFF(name, soup.points, soup.polygons, quiet);
    if (extension == ".stl") whole = CGAL::IO::read_STL(name, soup.points, soup.polygons, quiet);
    if (extension == ".ply") whole = CGAL::IO::read_PLY(name, soup.points, soup.polygons, quiet);
  } catch (const std::exception& error) {
    throw BadInput(name, std::string("cannot be understood (") + error.what() + ")", expected_mesh, remedy_export);
  }
  if (!whole)
    throw BadInput(name, "is truncated or damaged", "a whole " + extension.substr(1) + " file", remedy_export);
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

/// Ears cut in order of their quality would be nicer; scans hold quads at most, and those are cut along the shorter
/// diagonal.
void triangulate(const Soup& soup, std::vector<Triangle>& triangles, LoadRepairs& repairs) {
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  };
  for (const Polygon& polygon : soup.polygons) {
    if (polygon.size() > 3) ++repairs.triangulated_polygons;
    std::size_t first = 0;
    if (polygon.size() == 4) {
      const auto squared = [&](int i, int j) {
        return CGAL::squared_distance(soup.points[polygon[i]], soup.points[polygon[j]]);
      };
      first = squared(0, 2) <= squared(1, 3) ? 0 : 1;
    }
    const auto corner = [&](std::size_t i) { return polygon[(first + i) % polygon.size()]; };
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) add(corner(0), corner(i), corner(i + 1));
  }
}

bool has_area(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
  return (b - a).cross(c - a).squaredNorm() > 0;
}

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& file, LoadRepairs* repairs_out) {
  const std::string name = file.string();
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".drc") {
    TriangleMesh mesh = load_draco(file);
    compute_vertex_normals(mesh);
    return mesh;
  }
  static const std::set<std::string> known = {".obj", ".off", ".stl", ".ply"};
  if (!known.contains(extension))
    throw BadInput(name, "has the unknown extension '" + extension + "'", "obj, ply, stl, off or drc",
                   "convert the mesh");
  if (read_text(file).empty()) throw BadInput(name, "is empty", expected_mesh, remedy_export);

  const Soup soup = read_soup(file, extension);
  check_soup(name, soup);

  LoadRepairs repairs;
  std::vector<Triangle> triangles;
  triangulate(soup, triangles, repairs);

  // Merge vertices at the same place, in the order of the file; keep those that a triangle uses.
  TriangleMesh mesh;
  constexpr std::uint32_t unseen = ~0u;
  std::vector<std::uint32_t> new_index(soup.points.size(), unseen);
  std::map<std::array<float, 3>, std::uint32_t> at_place;
  for (Triangle& triangle : triangles)
    for (std::uint32_t& vertex : triangle) {
      if (new_index[vertex] == unseen) {
        const Point& p = soup.points[vertex];
        // Adding zero turns -0 into +0, which would be another key.
        const std::array<float, 3> place = {static_cast<float>(p.x()) + 0.f, static_cast<float>(p.y()) + 0.f,
                                            static_cast<float>(p.z()) + 0.f};
        const auto [found, inserted] = at_place.try_emplace(place, static_cast<std::uint32_t>(mesh.positions.size()));
        if (inserted)
          mesh.positions.emplace_back(place[0], place[1], place[2]);
        else
          ++repairs.merged_vertices;
        new_index[vertex] = found->second;
      }
      vertex = new_index[vertex];
    }
  repairs.unused_vertices = static_cast<int>(std::count(new_index.begin(), new_index.end(), unseen));

  std::set<Triangle> seen;
  for (const Triangle& triangle : triangles) {
    Triangle sorted = triangle;
    std::sort(sorted.begin(), sorted.end());
    const bool repeats = sorted[0] == sorted[1] || sorted[1] == sorted[2];
    if (repeats || !has_area(mesh, triangle) || !seen.insert(sorted).second)
      ++repairs.dropped_triangles;
    else
      mesh.triangles.push_back(triangle);
  }
  if (mesh.triangles.empty()) throw BadInput(name, "has no triangle with an area", expected_mesh, remedy_export);
  compute_vertex_normals(mesh);
  if (repairs_out != nullptr) *repairs_out = repairs;
  return mesh;
}

}  // namespace kiln
