// SPDX-License-Identifier: GPL-3.0-or-later
// Compares simplification with other libraries: CGAL's edge collapse (Lindstrom-Turk; Garland-Heckbert planes),
// meshoptimizer's and OpenMesh's quadrics, in one process and, except for Kiln, on one thread. Prints Markdown rows:
// CPU and wall seconds of the collapse (without the conversion of the mesh to each library's form), Hausdorff and RMS
// distance in % of the diagonal, worse direction (mesh_distance), RMS angle between normals, edges of more than two
// triangles.
//
//   bench_simplify [--mesh MESH] [--faces 5000 1000 500] [--only TEXT...] [--repeat 3] [--subdivide N] [--threads 2]
//   bench_simplify --measure HIGH LOW...    rows for meshes that others wrote, OBJ files of triangles
//   bench_simplify --write FILE.obj         the mesh, subdivided, for the peers' scripts
// --subdivide cuts each triangle into four, N times, and moves the vertices along their normals by noise of an eighth
// of an edge, so that no region is planar.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CLI/CLI.hpp>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <map>
#include <meshoptimizer.h>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "cost.h"
#include "import/import_mesh.h"
#include "mesh/mesh_distance.h"
#include "mesh/nearest_surface.h"
#include "simplify/collapse.h"
#include "simplify/reduce.h"

namespace {

using namespace kiln;
namespace SMS = CGAL::Surface_mesh_simplification;

int count_non_manifold_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) ++triangles[std::minmax(t[i], t[(i + 1) % 3])];
  int count = 0;
  for (const auto& [edge, number] : triangles) count += number > 2;
  return count;
}

using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

struct FewFaces {
  std::size_t faces;
  template <class FT, class Profile>
  bool operator()(const FT&, const Profile& profile, std::size_t, std::size_t) const {
    return profile.surface_mesh().number_of_faces() <= faces;
  }
};

Surface to_surface(const TriangleMesh& mesh) {
  Surface surface;
  for (const Eigen::Vector3f& p : mesh.positions) surface.add_vertex({p.x(), p.y(), p.z()});
  for (const Triangle& t : mesh.triangles)
    surface.add_face(Surface::Vertex_index(t[0]), Surface::Vertex_index(t[1]), Surface::Vertex_index(t[2]));
  return surface;
}

TriangleMesh from_surface(const Surface& surface) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> index(surface.num_vertices() + surface.number_of_removed_vertices());
  for (const auto v : surface.vertices()) {
    index[v] = static_cast<std::uint32_t>(mesh.positions.size());
    const auto& p = surface.point(v);
    mesh.positions.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  }
  for (const auto f : surface.faces()) {
    Triangle t;
    int i = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) t[i++] = index[v];
    mesh.triangles.push_back(t);
  }
  return mesh;
}

/// A simplifier: reduces a mesh to `faces` triangles, adding its time to `cost`.
using Simplifier = std::function<TriangleMesh(const TriangleMesh&, int faces, Cost& cost)>;

TriangleMesh cgal_lindstrom_turk(const TriangleMesh& mesh, int faces, Cost& cost) {
  Surface surface = to_surface(mesh);
  cost = cost_of([&] {
    SMS::edge_collapse(surface, FewFaces{static_cast<std::size_t>(faces)},
                       CGAL::parameters::get_cost(SMS::LindstromTurk_cost<Surface>())
                           .get_placement(SMS::LindstromTurk_placement<Surface>()));
  });
  return from_surface(surface);
}

TriangleMesh cgal_garland_heckbert(const TriangleMesh& mesh, int faces, Cost& cost) {
  Surface surface = to_surface(mesh);
  cost = cost_of([&] {
    const SMS::GarlandHeckbert_plane_policies<Surface, CGAL::Exact_predicates_inexact_constructions_kernel> policies(
        surface);
    SMS::edge_collapse(surface, FewFaces{static_cast<std::size_t>(faces)},
                       CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  });
  return from_surface(surface);
}

TriangleMesh meshoptimizer(const TriangleMesh& mesh, int faces, Cost& cost) {
  TriangleMesh result;
  result.positions = mesh.positions;
  std::vector<unsigned int> indices(mesh.triangles.size() * 3);
  cost = cost_of([&] {
    indices.resize(meshopt_simplify(indices.data(), mesh.triangles.front().data(), mesh.triangles.size() * 3,
                                    mesh.positions.front().data(), mesh.positions.size(), sizeof(Eigen::Vector3f),
                                    static_cast<std::size_t>(faces) * 3, 1e9f, 0, nullptr));
  });
  for (std::size_t i = 0; i < indices.size(); i += 3)
    result.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return result;
}

TriangleMesh openmesh(const TriangleMesh& mesh, int faces, Cost& cost) {
  struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
  };
  using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
  Mesh low;
  low.request_vertex_status();
  low.request_edge_status();
  low.request_face_status();
  low.request_halfedge_status();
  for (const Eigen::Vector3f& p : mesh.positions) low.add_vertex(Mesh::Point(p.x(), p.y(), p.z()));
  for (const Triangle& t : mesh.triangles)
    low.add_face(Mesh::VertexHandle(static_cast<int>(t[0])), Mesh::VertexHandle(static_cast<int>(t[1])),
                 Mesh::VertexHandle(static_cast<int>(t[2])));
  cost = cost_of([&] {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(low);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadrics;
    decimater.add(quadrics);
    decimater.module(quadrics).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, static_cast<std::size_t>(faces));
  });
  low.garbage_collection();
  TriangleMesh result;
  for (const auto v : low.vertices()) result.positions.push_back(Eigen::Vector3d(low.point(v).data()).cast<float>());
  for (const auto f : low.faces()) {
    Triangle t;
    int i = 0;
    for (auto v = low.cfv_ccwiter(f); v.is_valid(); ++v) t[i++] = static_cast<std::uint32_t>(v->idx());
    result.triangles.push_back(t);
  }
  return result;
}

Simplifier ours(SimplifyQuality quality) {
  return [quality](const TriangleMesh& mesh, int faces, Cost& cost) {
    TriangleMesh result;
    const auto distance = [&](const TriangleMesh& candidate) { return mesh_distance(mesh, candidate); };
    cost = cost_of([&] { result = reduce_to_faces(mesh, {.faces = faces, .quality = quality}, distance).mesh; });
    return result;
  };
}

/// Simplifies by Kiln's --engine cgal: CGAL on an OpenMesh mesh, with Kiln's borders and limits.
Simplifier ours_by_cgal(CollapseCost collapse_cost) {
  return [collapse_cost](const TriangleMesh& mesh, int faces, Cost& cost) {
    TriangleMesh result;
    SimplifySettings settings;
    settings.faces = faces;
    settings.engine = SimplifyEngine::cgal;
    settings.cost = collapse_cost;
    cost = cost_of([&] { result = reduce_to_faces(mesh, settings, {}).mesh; });
    return result;
  };
}

/// Computes the root mean square angle between the normals of `high` and those of `low` at the nearest point, degrees,
/// over the triangles of `high` by area.
double normal_error(const TriangleMesh& high, const TriangleMesh& low) {
  const NearestSurface surface(low);
  double sum = 0, area = 0;
  std::uint32_t hint = 0;
  for (const Triangle& t : high.triangles) {
    const Eigen::Vector3d a = high.positions[t[0]].cast<double>(), b = high.positions[t[1]].cast<double>(),
                          c = high.positions[t[2]].cast<double>();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > 0)) continue;
    const NearestSurface::Hit hit = surface.nearest((a + b + c) / 3, hint);
    hint = hit.hint;
    const double cosine = std::clamp(surface.normal(hit).dot(normal.normalized()), -1.0, 1.0);
    sum += normal.norm() * std::pow(std::acos(cosine) * 180 / std::numbers::pi, 2);
    area += normal.norm();
  }
  return std::sqrt(sum / area);
}

struct Entry {
  std::string name;
  Simplifier simplifier;
};

std::vector<Entry> entries() {
  return {{"kiln draft", ours(SimplifyQuality::draft)},
          {"kiln standard", ours(SimplifyQuality::standard)},
          {"kiln best", ours(SimplifyQuality::best)},
          {"engine cgal lindstrom-turk", ours_by_cgal(CollapseCost::lindstrom_turk)},
          {"engine cgal plane", ours_by_cgal(CollapseCost::plane)},
          {"engine cgal triangle", ours_by_cgal(CollapseCost::triangle)},
          {"engine cgal probabilistic-plane", ours_by_cgal(CollapseCost::probabilistic_plane)},
          {"engine cgal probabilistic-triangle", ours_by_cgal(CollapseCost::probabilistic_triangle)},
          {"CGAL Lindstrom-Turk", cgal_lindstrom_turk},
          {"CGAL Garland-Heckbert plane", cgal_garland_heckbert},
          {"meshoptimizer", meshoptimizer},
          {"OpenMesh quadrics", openmesh}};
}

void print_row(const std::string& name, const Cost& cost, const TriangleMesh& high, const TriangleMesh& low) {
  const MeshDistance distance = mesh_distance(high, low);
  std::printf("| %s | %zu | %.3f | %.3f | %.4f | %.4f | %.2f | %d |\n", name.c_str(), low.triangles.size(), cost.cpu,
              cost.wall, 100 * distance.hausdorff, 100 * distance.rms, normal_error(high, low),
              count_non_manifold_edges(low));
  std::fflush(stdout);
}

/// Reads the triangles of an OBJ file unchanged: load_mesh would repair what is to be counted.
TriangleMesh load_unrepaired(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file);
  TriangleMesh mesh;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Eigen::Vector3f& p = mesh.positions.emplace_back();
      words >> p.x() >> p.y() >> p.z();
    } else if (word == "f") {
      Triangle& t = mesh.triangles.emplace_back();
      for (std::uint32_t& vertex : t) {
        words >> word;  // 1, 1/2, 1//3 or 1/2/3
        vertex = static_cast<std::uint32_t>(std::stoul(word)) - 1;
      }
    }
  }
  return mesh;
}

TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.positions = mesh.positions;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size()));
    if (added) fine.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
    return found->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) fine.triangles.push_back(t);
  }
  compute_vertex_normals(fine);
  const double edge = std::sqrt(surface_area(fine) / static_cast<double>(fine.triangles.size()) * 4 / std::sqrt(3.0));
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < fine.positions.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    const double noise = static_cast<double>(state >> 8) / (1 << 24) - 0.5;
    fine.positions[i] += static_cast<float>(noise * edge / 8) * fine.normals[i];
  }
  fine.normals.clear();
  return fine;
}

}  // namespace

int main(int argc, char** argv) {
  std::string mesh_file = "/usr/share/glmark2/models/bunny.obj", write_file;
  std::vector<std::string> only, measured;
  std::vector<int> faces = {5000, 1000, 500};
  int repeat = 3, subdivisions = 0, threads = 2;
  CLI::App app("Simplification beside other libraries, as Markdown");
  app.add_option("--mesh", mesh_file)->capture_default_str();
  app.add_option("--faces", faces, "triangles to simplify to")->capture_default_str();
  app.add_option("--only", only, "rows whose name has one of these texts in it");
  app.add_option("--repeat", repeat, "runs, of which the quickest counts")->capture_default_str();
  app.add_option("--subdivide", subdivisions, "times that each triangle is cut into four")->capture_default_str();
  app.add_option("--threads", threads, "of ours")->capture_default_str();
  app.add_option("--measure", measured, "HIGH LOW...: just the distances of meshes that others wrote");
  app.add_option("--write", write_file, "just writes the mesh, an OBJ file");
  CLI11_PARSE(app, argc, argv);
  try {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    if (!measured.empty()) {
      const TriangleMesh high = load_mesh(measured.front());
      for (std::size_t i = 1; i < measured.size(); ++i)
        print_row(measured[i], {0, 0}, high, load_unrepaired(measured[i]));
      return 0;
    }
    TriangleMesh high = load_mesh(mesh_file);
    for (int i = 0; i < subdivisions; ++i) high = subdivided(high);
    if (!write_file.empty()) {
      std::FILE* file = std::fopen(write_file.c_str(), "w");
      if (file == nullptr) throw std::runtime_error("cannot write " + write_file);
      for (const Eigen::Vector3f& p : high.positions) std::fprintf(file, "v %.9g %.9g %.9g\n", p.x(), p.y(), p.z());
      for (const Triangle& t : high.triangles) std::fprintf(file, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
      std::fclose(file);
      return 0;
    }
    std::printf("%s, %zu triangles\n\n", mesh_file.c_str(), high.triangles.size());
    std::printf("| | triangles | CPU s | s | Hausdorff, %% | RMS, %% | normals, degrees | non-manifold edges |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    std::vector<Entry> chosen;
    for (const Entry& entry : entries()) {
      bool wanted = only.empty();
      for (const std::string& text : only) wanted = wanted || entry.name.find(text) != std::string::npos;
      if (wanted) chosen.push_back(entry);
    }
    for (const int target : faces) {
      // Interleaves the simplifiers, so that other load on the machine falls on all of them.
      std::vector<Cost> costs(chosen.size());
      std::vector<TriangleMesh> meshes(chosen.size());
      for (int i = 0; i < repeat; ++i)
        for (std::size_t k = 0; k < chosen.size(); ++k) {
          if (i > 0 && costs[k].cpu > 10) continue;
          Cost cost;
          meshes[k] = chosen[k].simplifier(high, target, cost);
          costs[k] = lesser(costs[k], cost);
        }
      for (std::size_t k = 0; k < chosen.size(); ++k) print_row(chosen[k].name, costs[k], high, meshes[k]);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_simplify: %s\n", error.what());
    return 1;
  }
  return 0;
}
