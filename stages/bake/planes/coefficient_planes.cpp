#include "bake/planes/coefficient_planes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "image/gutter.h"
#include "image/image_file.h"
#include "sh/basis.h"

namespace kiln {

namespace {

/// Looser than a normal map's, whose texels are the receivers' normals: gutters have no values of their own here.
constexpr SeamWeights plane_weights = {.covered = 0.02};

std::string plane_name(int channel, int coefficient) {
  return fmt::format("coeff_{}_{:02d}.png", channel, coefficient);
}

Image<float> filled_plane(std::span<const float> values, const TexelReceivers& receivers,
                          const std::vector<std::uint8_t>& filled) {
  Image<float> plane(receivers.width, receivers.height, 1);
  for (std::size_t r = 0; r < values.size(); ++r) plane.values()[receivers.texels[r]] = values[r];
  receivers.fills.apply(plane.values());
  fill_gutters(plane, filled);
  return plane;
}

/// Texels whose values come of receivers: their own, or those of others of their chart.
std::vector<std::uint8_t> filled_texels(const TexelReceivers& receivers) {
  std::vector<std::uint8_t> filled = receivers.covered();
  for (const FillPlan::Texel& fill : receivers.fills.texels) filled[fill.texel] = 1;
  return filled;
}

/// Points along the seams whose lookups see no buried texel: what mismatch is measured at.
std::vector<SeamPoint> seen_points(const Seams& seams, const TexelReceivers& receivers) {
  std::vector<std::uint8_t> is_buried(static_cast<std::size_t>(receivers.width) * receivers.height, 0);
  for (const std::uint32_t texel : receivers.buried) is_buried[texel] = 1;
  std::vector<SeamPoint> points = seams.measuring_points();
  std::erase_if(points, [&](const SeamPoint& point) {
    return std::any_of(point.sides.begin(), point.sides.end(), [&](const SeamSide& side) {
      return std::any_of(side.footprint.texels.begin(), side.footprint.texels.end(),
                         [&](std::uint32_t texel) { return is_buried[texel] != 0; });
    });
  });
  return points;
}

template <class Stored>
Image<Stored> store_plane(const Image<float>& plane, const PlaneRange& range, int bits) {
  Image<Stored> stored(plane.width(), plane.height(), 1);
  std::transform(plane.values().begin(), plane.values().end(), stored.values().begin(),
                 [&](float value) { return static_cast<Stored>(range.store(value, bits)); });
  return stored;
}

/// As a runtime sees it.
Image<float> shown_plane(const Image<float>& plane, const PlaneRange& range, int bits) {
  Image<float> shown(plane.width(), plane.height(), 1);
  std::transform(plane.values().begin(), plane.values().end(), shown.values().begin(),
                 [&](float value) { return range.recover(range.store(value, bits), bits); });
  return shown;
}

/// Adds up the distances between both sides of the seams, plane after plane.
class MismatchSums {
 public:
  explicit MismatchSums(const std::vector<SeamPoint>& points) : points_(points), squares_(points.size(), 0) {}

  void add(const Image<float>& shown) { Seams::add_squared_differences(points_, shown, 0, squares_); }

  SeamMismatch relative_to(double length) const {
    std::vector<double> differences(squares_.size());
    std::transform(squares_.begin(), squares_.end(), differences.begin(),
                   [&](double square) { return length > 0 ? std::sqrt(square) / length : 0; });
    return Seams::summarise(points_, differences);
  }

 private:
  const std::vector<SeamPoint>& points_;
  std::vector<double> squares_;
};

/// Has `solver` weigh those points more where it leaves more than elsewhere, by the planes that hold most of transfer.
void reweigh_points(SeamSolver& solver, const std::vector<TransferVectors>& channels, const TexelReceivers& receivers,
                    const std::vector<std::uint8_t>& filled) {
  constexpr int rounds = 2;
  constexpr int planes = 9;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> mismatches(solver.points().size(), 0);
    for (int i = 0; i < std::min(planes, channels[0].coefficients); ++i) {
      Image<float> plane = filled_plane(channels[0].plane(i), receivers, filled);
      solver.equalise(plane);
      Seams::add_squared_differences(solver.points(), plane, 0, mismatches);
    }
    for (double& mismatch : mismatches) mismatch = std::sqrt(mismatch);
    solver.reweigh(mismatches);
  }
}

template <class Stored>
void recover_plane(const Image<Stored>& stored, const PlaneRange& range, int bits, const TexelReceivers& receivers,
                   std::span<float> values) {
  for (std::size_t r = 0; r < values.size(); ++r) values[r] = range.recover(stored.values()[receivers.texels[r]], bits);
}

}  // namespace

std::uint32_t PlaneRange::store(float value, int bits) const {
  if (!(highest > lowest)) return 0;
  const double top = (1u << bits) - 1;
  const double place = (static_cast<double>(value) - lowest) / (static_cast<double>(highest) - lowest);
  return static_cast<std::uint32_t>(std::lround(std::clamp(place, 0.0, 1.0) * top));
}

float PlaneRange::recover(std::uint32_t stored, int bits) const {
  const double top = (1u << bits) - 1;
  return static_cast<float>(lowest + stored / top * (static_cast<double>(highest) - lowest));
}

PlaneRange range_of(std::span<const float> values) {
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return {*lowest, *highest};
}

void add_origin(Json& ranges, const TriangleMesh& mesh) {
  const Eigen::Vector3d& origin = mesh.frame.origin;
  if (!origin.isZero(0)) ranges["origin"] = {origin.x(), origin.y(), origin.z()};
}

Json ranges_head(int channels, int coefficients, int bits) {
  return {{"format", "kiln-prt"},
          {"version", 1},
          {"bands", band_of(coefficients - 1) + 1},
          {"channels", channels},
          {"bits", bits}};
}

void remove_stale_planes(OutputSet& outputs, const std::set<std::string>& written) {
  for (const auto& entry : std::filesystem::directory_iterator(outputs.folder())) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("coeff_") && name.ends_with(".png") && !written.contains(name)) outputs.remove_stale(name);
  }
}

WrittenPlanes write_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                           const TexelReceivers& receivers, int bits, const AssetFiles& files, const Seams& seams,
                           SeamChoice choice) {
  const std::vector<std::uint8_t> filled = filled_texels(receivers);
  const std::vector<SeamPoint> points = seen_points(seams, receivers);
  MismatchSums before(points), after(points);
  std::optional<SeamSolver> solver;
  if (choice == SeamChoice::equalise && !seams.edges().empty())
    reweigh_points(solver.emplace(seams, receivers.covered(), NormalSpace::object, plane_weights), channels, receivers,
                   filled);
  double squared_length = 0, squared_change = 0, squared_error = 0;

  std::set<std::string> written;
  Json planes = Json::array();
  for (std::size_t channel = 0; channel < channels.size(); ++channel)
    for (int i = 0; i < channels[channel].coefficients; ++i) {
      const std::span<const float> values = channels[channel].plane(i);
      // The range of what was baked is what is possible: no equalising and no slope that a gutter continues leaves it.
      const PlaneRange range = range_of(values);
      Image<float> plane = filled_plane(values, receivers, filled);
      before.add(shown_plane(plane, range, bits));
      if (solver) solver->equalise(plane, range.lowest, range.highest);
      const Image<float> shown = shown_plane(plane, range, bits);
      after.add(shown);
      for (std::size_t r = 0; r < values.size(); ++r) {
        const std::uint32_t texel = receivers.texels[r];
        const double value = values[r], equalised = plane.values()[texel];
        squared_length += value * value;
        squared_change += (equalised - value) * (equalised - value);
        squared_error += (shown.values()[texel] - equalised) * (shown.values()[texel] - equalised);
      }
      const std::string name = plane_name(static_cast<int>(channel), i);
      if (bits == 8)
        write_png(outputs.add(name), store_plane<std::uint8_t>(plane, range, bits));
      else
        write_png(outputs.add(name), store_plane<std::uint16_t>(plane, range, bits));
      written.insert(name);
      planes.push_back(
          {{"file", name}, {"channel", channel}, {"coefficient", i}, {"min", range.lowest}, {"max", range.highest}});
    }

  Json ranges = ranges_head(static_cast<int>(channels.size()), channels[0].coefficients, bits);
  ranges["width"] = receivers.width;
  ranges["height"] = receivers.height;
  ranges["basis"] = basis_name;
  ranges["mesh"] = files.mesh;
  if (!files.normals.empty()) ranges["normals"] = files.normals;
  if (!files.normals.empty() && files.normal_space == NormalSpace::tangent) ranges["normal_space"] = "tangent";
  if (!files.albedo.is_null()) ranges["albedo"] = files.albedo;
  add_origin(ranges, seams.atlas());
  ranges["planes"] = planes;
  outputs.add_text("ranges.json", ranges.dump(2) + "\n");
  remove_stale_planes(outputs, written);

  const double length = std::sqrt(squared_length / static_cast<double>(receivers.texels.size()));
  const auto relative = [&](double squared) { return squared_length > 0 ? std::sqrt(squared / squared_length) : 0; };
  return {before.relative_to(length), after.relative_to(length), relative(squared_change), relative(squared_error)};
}

std::vector<TransferVectors> read_planes(const std::filesystem::path& folder, const TexelReceivers& receivers) {
  const Json ranges = Json::parse(read_text(folder / "ranges.json"));
  const int bits = ranges["bits"], coefficients = coefficient_count(ranges["bands"]);
  std::vector<TransferVectors> channels(ranges["channels"].get<std::size_t>(),
                                        TransferVectors(receivers.texels.size(), coefficients));
  for (const Json& plane : ranges["planes"]) {
    const PlaneRange range{plane["min"], plane["max"]};
    const std::span<float> values = channels[plane["channel"].get<std::size_t>()].plane(plane["coefficient"]);
    const std::filesystem::path file = folder / plane["file"].get<std::string>();
    if (bits == 8)
      recover_plane(read_png8(file), range, bits, receivers, values);
    else
      recover_plane(read_png16(file), range, bits, receivers, values);
  }
  return channels;
}

}  // namespace kiln
