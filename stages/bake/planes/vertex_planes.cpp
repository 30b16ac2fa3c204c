#include "bake/planes/vertex_planes.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

#include "bake/planes/coefficient_planes.h"
#include "base/options.h"
#include "mesh/draco_file.h"
#include "sh/basis.h"

namespace kiln {

namespace {

constexpr int group_size = 4;  // coefficients of one attribute: a shader's vec4

}  // namespace

std::vector<std::uint32_t> write_vertex_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                                               const TexelReceivers& receivers, const TriangleMesh& mesh, int bits,
                                               const Json& albedo) {
  if (static_cast<std::size_t>(receivers.width) != mesh.positions.size())
    throw std::invalid_argument("write_vertex_planes: receivers of this mesh's vertices are needed");

  // Step 1: attributes.
  std::vector<IntegerAttribute> attributes;
  Json planes = Json::array();
  for (std::size_t channel = 0; channel < channels.size(); ++channel)
    for (int i = 0; i < channels[channel].coefficients; ++i) {
      const int group = i / group_size, component = i % group_size;
      if (component == 0) {
        IntegerAttribute attribute{fmt::format("kiln-prt-{}-{}", channel, group),
                                   std::min(group_size, channels[channel].coefficients - i),
                                   bits,
                                   {},
                                   0};
        attribute.values.resize(mesh.positions.size() * static_cast<std::size_t>(attribute.components));
        attributes.push_back(std::move(attribute));
      }
      IntegerAttribute& attribute = attributes.back();
      const std::span<const float> values = channels[channel].plane(i);
      const PlaneRange range = range_of(values);
      std::vector<float> plane(mesh.positions.size(), 0.f);  // dark where nothing fills a buried vertex
      for (std::size_t r = 0; r < values.size(); ++r) plane[receivers.texels[r]] = values[r];
      receivers.fills.apply(plane);
      for (std::size_t v = 0; v < plane.size(); ++v)
        attribute.values[v * static_cast<std::size_t>(attribute.components) + component] =
            static_cast<std::uint16_t>(range.store(plane[v], bits));
      planes.push_back({{"attribute", attribute.name},
                        {"unique_id", 0},
                        {"component", component},
                        {"channel", channel},
                        {"coefficient", i},
                        {"min", range.lowest},
                        {"max", range.highest}});
    }
  const std::filesystem::path file = outputs.add(vertex_mesh_name);
  const std::vector<std::uint32_t> sources = save_attributed_draco(file, mesh, attributes);

  // Step 2: the ids that Draco gave them.
  for (const IntegerAttribute& written : load_attributed_draco(file).attributes)
    for (Json& plane : planes)
      if (plane["attribute"] == written.name) plane["unique_id"] = written.unique_id;

  Json ranges = ranges_head(static_cast<int>(channels.size()), channels[0].coefficients, bits);
  ranges["vertices"] = sources.size();
  ranges["basis"] = basis_name;
  ranges["mesh"] = vertex_mesh_name;
  if (!albedo.is_null()) ranges["albedo"] = albedo;
  add_origin(ranges, mesh);
  ranges["planes"] = planes;
  outputs.add_text("ranges.json", ranges.dump(2) + "\n");
  remove_stale_planes(outputs, {});
  return sources;
}

std::vector<TransferVectors> read_vertex_planes(const std::filesystem::path& folder, const TexelReceivers& receivers,
                                                const std::vector<std::uint32_t>& sources) {
  constexpr std::uint32_t lost = ~0u;
  std::vector<std::uint32_t> place(static_cast<std::size_t>(receivers.width),
                                   lost);  // of a vertex of the mesh in the file
  for (std::uint32_t k = 0; k < sources.size(); ++k) place[sources[k]] = k;
  if (std::find(place.begin(), place.end(), lost) != place.end())
    throw std::invalid_argument("read_vertex_planes: a vertex has no proper triangle and is not in the file");

  const Json ranges = Json::parse(read_text(folder / "ranges.json"));
  const int bits = ranges["bits"], coefficients = coefficient_count(ranges["bands"]);
  const AttributedMesh stored = load_attributed_draco(folder / ranges["mesh"].get<std::string>());
  std::vector<TransferVectors> channels(ranges["channels"].get<std::size_t>(),
                                        TransferVectors(receivers.texels.size(), coefficients));
  for (const Json& plane : ranges["planes"]) {
    const auto attribute =
        std::find_if(stored.attributes.begin(), stored.attributes.end(),
                     [&](const IntegerAttribute& candidate) { return candidate.name == plane["attribute"]; });
    if (attribute == stored.attributes.end())
      throw std::runtime_error("the mesh has no attribute " + plane["attribute"].dump());
    const PlaneRange range{plane["min"], plane["max"]};
    const std::span<float> values = channels[plane["channel"].get<std::size_t>()].plane(plane["coefficient"]);
    const auto components = static_cast<std::size_t>(attribute->components);
    const std::size_t component = plane["component"];
    for (std::size_t r = 0; r < values.size(); ++r)
      values[r] = range.recover(attribute->values.at(place[receivers.texels[r]] * components + component), bits);
  }
  return channels;
}

}  // namespace kiln
