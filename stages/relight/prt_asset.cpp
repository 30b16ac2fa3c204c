#include "relight/prt_asset.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include "base/errors.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

constexpr int most_bands = 24;
constexpr int most_channels = 64;
constexpr int largest_side = 16384;
constexpr const char* remedy = "bake the asset again with kiln-bake";

/// The keys of a JSON object, each fetched with its type and range checked; faults name the file and the key.
class Fields {
 public:
  Fields(std::string file, std::string where, const json& object)
      : file_(std::move(file)), where_(std::move(where)), object_(object) {
    if (!object.is_object()) fail(where_.empty() ? "the file" : where_, shown(object), "a JSON object");
  }

  bool has(const char* key) const { return object_.contains(key); }

  const json& get(const char* key, const std::string& expected) const {
    if (!has(key)) throw BadInput(file_, "has no " + path(key), expected, remedy);
    return object_[key];
  }

  int integer(const char* key, int lowest, int highest) const {
    const std::string expected = "a whole number of " + std::to_string(lowest) + " to " + std::to_string(highest);
    const json& value = get(key, expected);
    const bool fits = value.is_number_unsigned() ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(highest)
                                                 : value.is_number_integer() && value.get<std::int64_t>() <= highest;
    if (!fits || value.get<std::int64_t>() < lowest) fail(path(key), shown(value), expected);
    return value.get<int>();
  }

  double number(const char* key) const {
    const std::string expected = "a finite number";
    const json& value = get(key, expected);
    if (!value.is_number() || !std::isfinite(value.get<float>())) fail(path(key), shown(value), expected);
    return value.get<double>();
  }

  std::string text(const char* key, const std::string& expected) const {
    const json& value = get(key, expected);
    if (!value.is_string()) fail(path(key), shown(value), expected);
    return value.get<std::string>();
  }

  void constant(const char* key, const std::string& expected) const {
    if (const std::string found = text(key, expected); found != expected) fail(path(key), shown(found), expected);
  }

  /// A path that stays inside the folder of the file.
  std::string safe_path(const char* key) const {
    const std::string expected = "the path of a file inside the folder, relative to it";
    const std::string found = text(key, expected);
    const fs::path as_path(found);
    const bool odd = found.empty() || std::any_of(found.begin(), found.end(), [](unsigned char c) { return c < 32; });
    const bool outside = as_path.is_absolute() || std::find(as_path.begin(), as_path.end(), "..") != as_path.end();
    if (odd || outside) fail(path(key), shown(found), expected);
    return found;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& found, const std::string& expected) const {
    throw BadInput(file_, what + " is " + found, expected, remedy);
  }

  std::string path(const char* key) const { return where_.empty() ? key : where_ + "." + key; }

 private:
  static std::string shown(const json& value) {
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    constexpr std::size_t longest = 60;
    return text.size() <= longest ? text : text.substr(0, longest) + "...";
  }

  std::string file_;
  std::string where_;
  const json& object_;
};

json parse_json(const fs::path& file) {
  try {
    return json::parse(read_text(file));
  } catch (const json::exception&) {
    throw BadInput(file.string(), "is no whole JSON file", "what kiln-bake writes", remedy);
  }
}

PrtPlane read_plane(const Fields& fields, const PrtAsset& asset, int index) {
  const int coefficients = asset.bands * asset.bands;
  PrtPlane plane;
  plane.file = fields.safe_path("file");
  plane.channel = fields.integer("channel", 0, asset.channels - 1);
  plane.coefficient = fields.integer("coefficient", 0, coefficients - 1);
  if (plane.channel != index / coefficients || plane.coefficient != index % coefficients)
    fields.fail(fields.path("coefficient"),
                std::to_string(plane.coefficient) + " of channel " + std::to_string(plane.channel),
                "coefficient " + std::to_string(index % coefficients) + " of channel " +
                    std::to_string(index / coefficients) + " (each plane once, in order)");
  plane.lowest = fields.number("min");
  plane.highest = fields.number("max");
  if (plane.lowest > plane.highest)
    fields.fail(fields.path("min"), std::to_string(plane.lowest) + ", above max " + std::to_string(plane.highest),
                "min <= max");
  return plane;
}

/// Fills in everything that stands in ranges.json itself; returns the path of the mesh.
std::string read_ranges(const fs::path& file, PrtAsset& asset) {
  const json document = parse_json(file);
  const Fields fields(file.string(), "", document);
  fields.constant("format", "kiln-prt");
  fields.integer("version", 1, 1);
  fields.constant("basis", "real-sh-orthonormal");
  asset.bands = fields.integer("bands", 1, most_bands);
  asset.channels = fields.integer("channels", 1, most_channels);
  asset.bits = fields.integer("bits", 8, 16);
  if (asset.bits != 8 && asset.bits != 16) fields.fail("bits", std::to_string(asset.bits), "8 or 16");
  asset.width = fields.integer("width", 1, largest_side);
  asset.height = fields.integer("height", 1, largest_side);
  const std::string mesh = fields.safe_path("mesh");
  // Shading does not read the normal map, the transfer holds the normals already.
  if (fields.has("normals")) fields.safe_path("normals");

  const std::size_t count = static_cast<std::size_t>(asset.channels) * asset.bands * asset.bands;
  const std::string expected = "a list of " + std::to_string(count) + " planes";
  const json& planes = fields.get("planes", expected);
  if (!planes.is_array()) fields.fail("planes", "no list", expected);
  if (planes.size() != count) fields.fail("planes", "a list of " + std::to_string(planes.size()), expected);
  for (std::size_t k = 0; k < count; ++k) {
    const Fields plane(file.string(), "planes[" + std::to_string(k) + "]", planes[k]);
    asset.planes.push_back(read_plane(plane, asset, static_cast<int>(k)));
  }
  return mesh;
}

Image<std::uint8_t> read_grey(const fs::path& file, std::uint8_t) { return read_png8(file); }
Image<std::uint16_t> read_grey(const fs::path& file, std::uint16_t) { return read_png16(file); }

/// All coefficient pictures. The first plane at fault is the one that is told of, whatever the number of threads.
template <class Texel>
std::vector<Image<Texel>> read_pictures(const fs::path& folder, const PrtAsset& asset) {
  std::vector<Image<Texel>> pictures(asset.planes.size());
  std::vector<std::exception_ptr> faults(asset.planes.size());
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t k) {
    const fs::path file = folder / asset.planes[k].file;
    try {
      pictures[k] = read_grey(file, Texel{});
      const std::string size = std::to_string(pictures[k].width()) + " x " + std::to_string(pictures[k].height());
      const std::string expected = std::to_string(asset.width) + " x " + std::to_string(asset.height);
      if (size != expected)
        throw BadInput(file.string(), "is " + size + " texels", expected + ", as ranges.json has it", remedy);
      if (pictures[k].channels() != 1)
        throw BadInput(file.string(), "has " + std::to_string(pictures[k].channels()) + " channels", "a grey PNG",
                       remedy);
    } catch (...) {
      faults[k] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
  return pictures;
}

/// The mesh, fit to be drawn.
TriangleMesh read_mesh(const fs::path& file) {
  TriangleMesh mesh = load_atlas(file);
  const auto is_there = [&](std::uint32_t vertex) { return vertex < mesh.positions.size(); };
  for (const Triangle& triangle : mesh.triangles)
    if (!std::all_of(triangle.begin(), triangle.end(), is_there))
      throw BadInput(file.string(), "has a triangle with a vertex that is not there", "the output of kiln-atlas",
                     remedy);
  const float diagonal = bounding_box(mesh).diagonal();
  if (!(std::isfinite(diagonal) && diagonal > 0))
    throw BadInput(file.string(), "is as large as " + std::to_string(diagonal), "a mesh of finite size above 0",
                   "scale the mesh and start over with kiln-simplify");
  return mesh;
}

}  // namespace

PrtAsset load_prt_asset(const fs::path& folder) {
  std::error_code error;
  const fs::path ranges = folder / "ranges.json";
  if (!fs::is_directory(folder, error) || !fs::is_regular_file(ranges, error))
    throw BadInput(folder.string(), fs::is_directory(folder, error) ? "has no ranges.json" : "is no folder",
                   "the output folder of kiln-bake", "run kiln-bake, or name its output folder");
  PrtAsset asset;
  asset.ranges_file = ranges;
  const std::string mesh = read_ranges(ranges, asset);
  asset.mesh = read_mesh(folder / mesh);
  if (asset.bits == 8)
    asset.pictures = read_pictures<std::uint8_t>(folder, asset);
  else
    asset.pictures = read_pictures<std::uint16_t>(folder, asset);
  return asset;
}

}  // namespace kiln
