// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/outputs.h"
#include "base/parallel.h"
#include "compress/clustered_pca.h"
#include "compress/compress.h"
#include "compress/compress_files.h"
#include "compress/small_png.h"
#include "compress/stored_pca.h"
#include "gpu/egl_context.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"
#include "prt_folders.h"
#include "runtime/decode/plane_weights.h"
#include "scratch.h"
#include "sh/light_spec.h"
#include "shapes.h"

namespace kiln {
namespace test_compress {

namespace fs = std::filesystem;
using nlohmann::json;

/// Transfer vector of a texel, as a function of column and row.
using Transfer = std::function<Eigen::VectorXd(int, int)>;

/// Makes a plain asset of 16 bits with the plane of shapes::plane, which leaves a tenth of the atlas free at each side.
PrtAsset make_asset(int width, int height, int bands, int channels, const Transfer& transfer) {
  PrtAsset asset;
  asset.ranges_file = "made in memory";
  asset.mesh_file = "atlas.drc";
  asset.mesh = shapes::plane(1);
  asset.bands = bands;
  asset.channels = channels;
  asset.bits = 16;
  asset.width = width;
  asset.height = height;
  const int length = channels * bands * bands;
  std::vector<Image<float>> planes(static_cast<std::size_t>(length), Image<float>(width, height, 1));
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const Eigen::VectorXd vector = transfer(i, j);
      for (int k = 0; k < length; ++k) planes[static_cast<std::size_t>(k)].at(i, j) = static_cast<float>(vector[k]);
    }
  std::vector<Image<std::uint16_t>> pictures;
  for (int k = 0; k < length; ++k) {
    const std::vector<float>& values = planes[static_cast<std::size_t>(k)].values();
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double lowest = *low, highest = *high;
    asset.planes.push_back({"coeff.png", k / (bands * bands), k % (bands * bands), {lowest, highest}, 16});
    Image<std::uint16_t>& picture = pictures.emplace_back(width, height, 1);
    if (highest > lowest)
      std::transform(values.begin(), values.end(), picture.values().begin(), [&](float value) {
        return static_cast<std::uint16_t>(std::lround((value - lowest) / (highest - lowest) * 65535));
      });
  }
  asset.pictures = std::move(pictures);
  return asset;
}

/// Makes smooth weights of `rank` fixed vectors about a mean.
Transfer of_rank(int rank, int length) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-0.1, 0.1);
  Eigen::MatrixXd basis(length, rank);
  Eigen::VectorXd mean(length);
  for (Eigen::Index k = 0; k < basis.size(); ++k) basis.data()[k] = value(random);
  for (Eigen::Index k = 0; k < mean.size(); ++k) mean[k] = value(random);
  return [=](int i, int j) {
    Eigen::VectorXd vector = mean;
    for (int r = 0; r < rank; ++r) vector += std::sin(0.1 * (r + 1) * i + 0.13 * (rank - r) * j) * basis.col(r);
    return vector;
  };
}

/// Makes two parts of the atlas, each of rank two, in different subspaces.
Transfer of_two_clusters(int length, int border) {
  return [=](int i, int j) {
    Eigen::VectorXd vector = Eigen::VectorXd::Constant(length, 0.05);
    const int at = i < border ? 0 : 2;
    vector[0] = i < border ? 0.25 : 0.1;
    vector[1 + at] += 0.2 * std::sin(0.2 * i + 0.1 * j);
    vector[2 + at] += 0.15 * std::cos(0.15 * i - 0.2 * j);
    return vector;
  };
}

Transfer noise(int length) {
  return [=](int i, int j) {
    std::mt19937 random(static_cast<std::uint32_t>(1000 * j + i));
    Eigen::VectorXd vector(length);
    for (int k = 0; k < length; ++k) vector[k] = (k == 0 ? 0.2 : 0) + 0.05 / (k + 1) * (random() / 4294967296.0 - 0.5);
    return vector;
  };
}

double error_of(const TransferSource& source, double residual) {
  return std::sqrt(std::max(0.0, residual) / source.squared_norm());
}

/// Writes a compressed folder as the command line would, and reads it.
PrtAsset written(const fs::path& folder, const PrtAsset& asset, const CompressResult& result, Json* metrics = nullptr) {
  const fs::path input = folder / "in", output = folder / "out";
  fs::create_directories(input);
  save_draco(input / "atlas.drc", asset.mesh);
  PrtAsset named = asset;  // sizes of the input are asked for
  named.ranges_file = input / "ranges.json";
  for (const auto& [name, bytes] : encode_planes(asset, asset.bits, PngEffort::quick))
    std::ofstream(input / name, std::ios::binary) << bytes;
  for (PrtPlane& plane : named.planes) {
    const std::string number = std::to_string(plane.coefficient);
    plane.file = "coeff_" + std::to_string(plane.channel) + "_" + (number.size() < 2 ? "0" : "") + number + ".png";
  }
  OutputSet outputs(output);
  const Json said = save_compressed(outputs, input, named, result);
  if (metrics != nullptr) *metrics = said;
  outputs.commit();
  return load_prt_asset(output);
}

// ---- PNG ----

TEST(SmallPng, ReadsBack) {
  const Scratch scratch;
  std::mt19937 random(1);
  struct Case {
    int width, height, bits;
    PngEffort effort;
  };
  // The last two are so large that filters are chosen on a part of them; their last band is not whole.
  for (const auto& [width, height, bits, effort] :
       {Case{37, 19, 8, PngEffort::quick}, Case{37, 19, 8, PngEffort::thorough}, Case{37, 19, 16, PngEffort::quick},
        Case{37, 19, 16, PngEffort::thorough}, Case{1100, 1001, 8, PngEffort::thorough},
        Case{70001, 9, 16, PngEffort::thorough}}) {
    Image<std::uint16_t> image(width, height, 1);
    for (std::size_t k = 0; k < image.values().size(); ++k)
      image.values()[k] = static_cast<std::uint16_t>((10 * k + random() % 7) & (bits == 8 ? 0xffu : 0xffffu));
    const fs::path file = scratch.folder() / "grey.png";
    std::ofstream(file, std::ios::binary) << encode_grey_png(image, bits, effort);
    if (bits == 16) {
      EXPECT_EQ(read_png16(file).values(), image.values());
    } else {
      const Image<std::uint8_t> read = read_png8(file);
      EXPECT_EQ(std::vector<std::uint16_t>(read.values().begin(), read.values().end()), image.values());
    }
  }
}

// ---- PCA ----

TEST(Pca, OfTheRightRankLosesNothing) {
  // 16 bits over a range of 0.4 round by 2e-6; with fewer components than there are, something of 0.05 goes.
  const PrtAsset asset = make_asset(64, 48, 3, 1, of_rank(4, 9));
  const TransferSource source(asset);
  const PrincipalComponents all = principal_components(source);
  EXPECT_LT(error_of(source, all.residual[4]), 3e-5);
  EXPECT_GT(error_of(source, all.residual[3]), 0.02);
  for (int n = 0; n < 9; ++n) EXPECT_GE(all.residual[n], all.residual[n + 1]) << n;

  // Texels lose as much as the eigenvalues predict.
  for (const int n : {0, 2, 3, 4, 9}) {
    const TexelModel model = texel_model(source, all.model(n), gutter_owners(source, 4));
    if (n == 0) continue;
    const double measured = error_spread(source, stored_errors(source, model, 1e-7), std::span(source.covered())).mean;
    EXPECT_NEAR(measured, error_of(source, all.residual[static_cast<std::size_t>(n)]), 3e-5) << n;
  }
}

TEST(Pca, WeighsErrorsByTheLightingPrior) {
  // The same variation in a coefficient of band 0 and in one of band 2, whose moment is 0.1536 (docs/error.md).
  const PrtAsset asset = make_asset(40, 40, 3, 1, [](int i, int j) {
    Eigen::VectorXd vector = Eigen::VectorXd::Zero(9);
    vector[0] = 0.1 * std::sin(0.4 * i);
    vector[5] = 0.1 * std::sin(0.4 * j);
    return vector;
  });
  const TransferSource source(asset);
  const PrincipalComponents all = principal_components(source);
  EXPECT_NEAR(std::abs(all.vectors(0, 0)), 1, 1e-3);
  EXPECT_NEAR(all.variances[1] / all.variances[0], 0.1536, 1e-5);  // planes of 16 bits
}

TEST(ClusteredPca, TwoSubspacesNeedTwoClusters) {
  const PrtAsset asset = make_asset(64, 64, 3, 1, of_two_clusters(9, 30));
  const TransferSource source(asset);
  const PrincipalComponents all = principal_components(source);
  EXPECT_GT(error_of(source, all.residual[2]), 0.05);  // one cluster has to do with two components
  const ClusteredPca two = clustered_pca(source, all, 2, 2, 1);
  EXPECT_LT(error_of(source, two.residual), 1e-4);
  for (std::size_t k = 0; k < source.covered().size(); ++k)
    ASSERT_EQ(two.ids[k] == two.ids[0], source.covered()[k] % 64 < 30) << k;
  // More clusters and more components never leave more, as far as local optima go.
  EXPECT_GT(error_of(source, clustered_pca(source, all, 2, 1, 1).residual), 1e-2);
}

TEST(ClusteredPca, EveryTexelHasTheNearestSubspaceNearly) {
  // Texels try the subspaces around the mean next to them alone, 16 of 64, and others reach far here, where what varies
  // is spread over seven dimensions: 9 % more is left than by trying all, 5 % after more rounds. A third, which is
  // allowed, is less than what trying four leaves, 58 %.
  const PrtAsset asset = make_asset(96, 80, 3, 1, of_rank(7, 9));
  const TransferSource source(asset);
  const PrincipalComponents all = principal_components(source);
  ClusteredPca clustered = clustered_pca(source, all, 64, 2, 1);
  const auto check = [&] {
    const Eigen::MatrixXf vectors = source.vectors(source.covered());
    double nearest = 0, given = 0;
    for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
      double least = INFINITY;
      for (std::size_t c = 0; c < clustered.model.means.size(); ++c) {
        const Eigen::VectorXd x = (vectors.col(k) - clustered.model.means[c]).cast<double>();
        const double distance =
            (x - clustered.model.bases[c].cast<double>() * (clustered.model.bases[c].cast<double>().transpose() * x))
                .squaredNorm();
        least = std::min(least, distance);
        if (c == clustered.ids[static_cast<std::size_t>(k)]) given += distance;
      }
      nearest += least;
    }
    EXPECT_LT(given, 1.33 * nearest);
    EXPECT_NEAR(clustered.residual, given, 1e-3 * given);  // in float32
    return given;
  };
  const double before = check();
  improve(source, all, clustered);
  EXPECT_LT(check(), before);
}

TEST(ClusteredPca, MoreClustersThanTexelsThatDiffer) {
  const PrtAsset asset = make_asset(
      32, 32, 2, 1, [](int i, int) { return Eigen::VectorXd(Eigen::VectorXd::Constant(4, i < 16 ? 0.1 : 0.2)); });
  const TransferSource source(asset);
  const ClusteredPca clustered = clustered_pca(source, principal_components(source), 64, 2, 1);
  EXPECT_EQ(clustered.model.clusters(), 2);
  EXPECT_LT(error_of(source, clustered.residual), 1e-5);
}

// ---- the worst ----

TEST(ErrorSpread, IsThatOfTheErrorsItIsGiven) {
  // 32 x 32 texels of squared length 4 x 0.01 before weights; errors are made up.
  const PrtAsset asset =
      make_asset(32, 32, 1, 1, [](int, int) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, 0.1)); });
  const TransferSource source(asset, std::vector<std::uint8_t>(32 * 32, 1));
  // 0.001 everywhere, 0.01 in two texels of 1,024: more than 1 in 1,000. Clusters meet between columns 15 and 16, where
  // the error steps from 0.001 to -0.001 in most rows.
  const TexelErrors errors = [](std::span<const std::uint32_t> texels) {
    Eigen::MatrixXf values(1, static_cast<Eigen::Index>(texels.size()));
    for (std::size_t k = 0; k < texels.size(); ++k) {
      const float magnitude = texels[k] == 5 || texels[k] == 700 ? 0.01f : 0.001f;
      values(0, static_cast<Eigen::Index>(k)) = texels[k] % 32 < 16 ? magnitude : -magnitude;
    }
    return values;
  };
  std::vector<std::uint8_t> ids(32 * 32, 0);
  for (std::size_t texel = 0; texel < ids.size(); ++texel) ids[texel] = texel % 32 >= 16;
  const ErrorSpread spread = error_spread(source, errors, std::span<const std::uint8_t>(ids));
  EXPECT_NEAR(spread.mean, std::sqrt((1022 * 1e-6 + 2 * 1e-4) / 1024) / 0.1, 1e-5);
  EXPECT_NEAR(spread.texel, 0.1, 1e-5);
  EXPECT_NEAR(spread.border, 0.02, 1e-5) << "all 32 jumps are 0.002";
  const ErrorSpread without = error_spread(source, errors, std::span<const std::uint8_t>());
  EXPECT_EQ(without.border, 0);
  EXPECT_EQ(without.texel, spread.texel);
  const std::vector<std::uint32_t> some = {1, 2, 40};
  EXPECT_NEAR(error_spread(source, errors, std::span<const std::uint32_t>(some)).texel, 0.01, 1e-5);
}

TEST(ErrorSpread, JumpsUpwardsCountToo) {
  // Clusters by rows, over more rows than a strip has: the step of every fourth row is one up.
  const PrtAsset asset =
      make_asset(8, 64, 1, 1, [](int, int) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, 0.1)); });
  const TransferSource source(asset, std::vector<std::uint8_t>(8 * 64, 1));
  std::vector<std::uint8_t> ids(8 * 64);
  for (std::size_t texel = 0; texel < ids.size(); ++texel) ids[texel] = texel / 8 >= 16;
  const TexelErrors errors = [&](std::span<const std::uint32_t> texels) {
    Eigen::MatrixXf values(1, static_cast<Eigen::Index>(texels.size()));
    for (std::size_t k = 0; k < texels.size(); ++k)
      values(0, static_cast<Eigen::Index>(k)) = ids[texels[k]] != 0 ? 0.003f : 0.001f;
    return values;
  };
  EXPECT_NEAR(error_spread(source, errors, std::span<const std::uint8_t>(ids)).border, 0.02, 1e-5);
}

// ---- stored weights ----

TEST(StoredPca, RoundingCostsWhatItShould) {
  // Noise of all components: uniform steps cost step^2 / 12 for each component of a texel (the rounded basis of one
  // cluster adds some 1 % of that); steps are 1/20 of the deviation and less, so that rounding is uniform.
  const PrtAsset asset = make_asset(96, 80, 2, 1, noise(4));
  const TransferSource source(asset);
  const PrincipalComponents all = principal_components(source);
  for (const double step : {2e-4, 4e-4}) {
    const TexelModel model = texel_model(source, all.model(4), gutter_owners(source, 4));
    const TexelModel rounded{rounded_model(model.model, source, all, step), model.ids, {}};
    const double error = error_spread(source, stored_errors(source, rounded, step), std::span(source.covered())).mean;
    const double per_texel = error * error * source.squared_norm() / static_cast<double>(source.covered().size());
    EXPECT_NEAR(per_texel / (4 * step * step / 12), 1, 0.06) << step;
  }
}

TEST(StoredPca, GutterTexelsAreOfTheNearestChartTexel) {
  const PrtAsset asset = make_asset(40, 40, 2, 1, noise(4));
  const TransferSource source(asset);
  const std::vector<std::uint32_t> owners = gutter_owners(source, 2);
  const std::vector<std::uint8_t>& covered = source.coverage();
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i) {
      int nearest = 99;  // ring, and the same of the owner
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
          if (covered[static_cast<std::size_t>(40 * y + x)] != 0)
            nearest = std::min(nearest, std::max(std::abs(x - i), std::abs(y - j)));
      const std::uint32_t owner = owners[static_cast<std::size_t>(40 * j + i)];
      ASSERT_EQ(owner == no_owner, nearest > 2);
      if (owner == no_owner) continue;
      ASSERT_NE(covered[owner], 0);
      ASSERT_EQ(std::max(std::abs(static_cast<int>(owner % 40) - i), std::abs(static_cast<int>(owner / 40) - j)),
                nearest);
    }
}

// ---- the stage ----

TEST(Compress, KeepsItsErrorAndSaysItsBytes) {
  const Scratch scratch;
  const PrtAsset asset = make_asset(36, 36, 3, 1, of_two_clusters(9, 18));
  struct Case {
    int clusters, components;
    const char* error;
  };
  for (const Case& c :
       {Case{0, 0, "auto"}, {0, 0, "0.01"}, {1, 0, "0.003"}, {2, 2, "0.002"}, {1, 9, "1e-4"}, {0, 0, "1e-6"}}) {
    CompressSettings settings;
    settings.clusters = c.clusters;
    settings.components = c.components;
    settings.max_error = parse_compression_error(c.error);
    const CompressResult result = compress(asset, settings);
    Json metrics;
    const PrtAsset read = written(scratch.folder(), asset, result, &metrics);
    const double error = spread_of_decoded(read, TransferSource(asset)).mean;
    EXPECT_LE(error, result.target_error) << c.error;
    // The search rounds in float32 as the reader does, in another order.
    EXPECT_NEAR(error, result.chosen.error, 1e-3 * error + 1e-6);
    EXPECT_NEAR(metrics["error"].get<double>(), error, 1e-12);
    std::uint64_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(scratch.folder() / "out"))
      if (entry.path().filename() != "atlas.drc") bytes += entry.file_size();
    EXPECT_EQ(bytes, result.chosen.bytes);
    if (c.clusters > 0) {
      EXPECT_EQ(result.chosen.clusters, c.clusters);
    }
    if (c.components > 0) {
      EXPECT_EQ(result.chosen.components, c.components);
    }
    if (std::string(c.error) == "1e-6") {
      EXPECT_EQ(result.chosen.scheme, CompressScheme::planes);  // 16-bit planes as they are: nothing else is that good
      EXPECT_EQ(error, 0);
    }
  }
}

TEST(Compress, MoreErrorNeverCostsMore) {
  const PrtAsset asset = make_asset(64, 64, 3, 1, noise(9));
  std::uint64_t last = ~0ull;
  for (const char* error : {"0.001", "0.003", "0.01", "0.03"}) {
    CompressSettings settings;
    settings.clusters = 1;
    settings.max_error = parse_compression_error(error);
    const CompressResult result = compress(asset, settings);
    EXPECT_LT(result.chosen.bytes, last) << error;
    last = result.chosen.bytes;
  }
}

TEST(Compress, ShowsWhatMoreErrorWouldSave) {
  const PrtAsset asset = make_asset(64, 64, 3, 1, noise(9));  // of 16 bits
  CompressSettings settings;
  settings.clusters = 1;
  settings.max_error = 0.003;
  const CompressResult result = compress(asset, settings);
  EXPECT_NEAR(result.plain.error, spread_of_decoded(with_eight_bits(asset), TransferSource(asset)).mean,
              1e-6 * result.plain.error);
  const PrincipalComponents all = principal_components(TransferSource(asset));
  int beyond = 0;
  for (const CompressCandidate& candidate : result.tried) {
    EXPECT_EQ(candidate.feasible, candidate.error <= 0.003);
    if (candidate.feasible) continue;
    ++beyond;
    EXPECT_LT(candidate.bytes, result.chosen.bytes);
    // The model's residual, plus at most a quarter more for rounding.
    const double left =
        std::sqrt(all.residual[static_cast<std::size_t>(candidate.components)] / TransferSource(asset).squared_norm());
    EXPECT_GE(candidate.error, left);
    EXPECT_LE(candidate.error, 1.25 * left);
  }
  EXPECT_GE(beyond, 1);
}

TEST(Compress, GivesTheSameFilesWithAnyThreads) {
  const PrtAsset asset = make_asset(128, 100, 2, 3, noise(12));
  CompressSettings settings;
  settings.clusters = 8;
  settings.components = 3;
  std::vector<std::pair<std::string, std::string>> files[2];
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    files[threads == 4] = compress(asset, settings).files;
  }
  EXPECT_EQ(files[0], files[1]);
}

TEST(Compress, RefusesWhatCannotBe) {
  const PrtAsset asset = make_asset(32, 32, 2, 1, noise(4));
  CompressSettings settings;
  settings.clusters = 1;
  settings.components = 1;
  settings.max_error = 1e-4;
  EXPECT_THROW(compress(asset, settings), WrongUsage);
  settings.components = 5;
  settings.max_error.reset();
  EXPECT_THROW(compress(asset, settings), WrongUsage);
  for (const char* error : {"", "0", "2", "much", "0.1x", "nan"})
    EXPECT_THROW(parse_compression_error(error), WrongUsage) << error;
}

TEST(Compress, RefusesTransferWhoseSquaresFloatsDoNotHold) {
  PrtAsset asset = make_asset(32, 32, 2, 1, noise(4));
  const auto scaled = [&](double factor) {
    PrtAsset other = asset;
    for (PrtPlane& plane : other.planes) plane.range = {factor * plane.range.lowest, factor * plane.range.highest};
    return other;
  };
  // It wrote errors of null at 1e30, and took any loss for none at 1e-30.
  for (const double factor : {1e30, 1e-30}) EXPECT_THROW(compress(scaled(factor), {}), BadInput) << factor;
  const double error = compress(asset, {}).chosen.error;
  for (const double factor : {0x1p30, 0x1p-30}) EXPECT_EQ(compress(scaled(factor), {}).chosen.error, error) << factor;
  EXPECT_EQ(compress(scaled(0), {}).chosen.error, 0);
}

// ---- reading and relighting ----

TEST(PcaAsset, RefusesMalformedFolders) {
  const Scratch scratch;
  const PrtAsset asset = make_asset(32, 24, 2, 1, noise(4));
  CompressSettings settings;
  settings.clusters = 2;
  settings.components = 2;
  written(scratch.folder(), asset, compress(asset, settings));
  const fs::path folder = scratch.folder() / "out", file = folder / pca_name;
  const json whole = json::parse(read_text(file));
  struct Case {
    const char* pointer;
    json value;  // null: the key goes
    const char* words;
  };
  const std::vector<Case> cases = {{"/format", "kiln-prt", "kiln-prt-pca"},
                                   {"/version", 3, "version is 3"},
                                   {"/bands", 3, "9 numbers"},
                                   {"/channels", 2, "4 x"},
                                   {"/width", 31, "31 x 24"},
                                   {"/clusters", 257, "1 to 256"},
                                   {"/clusters", 1, "x 3"},
                                   {"/components", 3, "a list of 3 planes"},
                                   {"/components", 0, "components is 0"},
                                   {"/planes/0/bits", 12, "8 or 16"},
                                   {"/planes/0/min", "x", "planes[0].min"},
                                   {"/planes/1/file", "../weight_01.png", "inside the folder"},
                                   {"/vector_ranges", json::array(), "3 ranges"},
                                   {"/vector_ranges/1/max", -1e9, "above max"},
                                   {"/coefficient_scales/0", "a", "finite numbers"},
                                   {"/cluster_ids", nullptr, "has no cluster_ids"},
                                   {"/vectors_file", "none.png", "none.png"},
                                   {"/mesh", nullptr, "has no mesh"}};
  for (const Case& c : cases) {
    json changed = whole;
    if (c.value.is_null())
      changed.erase(std::string(c.pointer).substr(1));
    else
      changed[json::json_pointer(c.pointer)] = c.value;
    std::ofstream(file, std::ios::trunc) << changed.dump();
    try {
      load_prt_asset(folder);
      ADD_FAILURE() << c.pointer << " was taken";
    } catch (const BadInput& fault) {
      EXPECT_NE(std::string(fault.what()).find(c.words), std::string::npos) << c.pointer << ": " << fault.what();
    }
  }
  std::ofstream(file, std::ios::trunc) << whole.dump();
  EXPECT_NO_THROW(load_prt_asset(folder));
  write_png(folder / "clusters.png", Image<std::uint8_t>(32, 24, 1, 2));
  EXPECT_THROW(load_prt_asset(folder), BadInput);  // a cluster that is not there
}

TEST(PcaAsset, GpuAndCpuAgree) {
  const Scratch scratch;
  const EglContext context("software");
  const std::vector<LightSpec> lights = {parse_light_spec("30,50,1,0.5,0.2"), parse_light_spec("-120,10,0,0.5,1"),
                                         parse_light_spec("ambient:0.3")};
  const std::array<float, 3> albedo = {1, 0.6f, 0.3f};
  constexpr int width = 24, height = 20;
  struct Case {
    int clusters, components, channels;
    const char* error;
  };
  // Noise: every lookup's four texels are of several clusters or may be. 5 planes leave a layer partly empty.
  for (const Case& c : {Case{1, 4, 1, "auto"}, {1, 27, 3, "1e-4"}, {6, 5, 1, "auto"}, {3, 8, 3, "auto"}}) {
    const PrtAsset asset = make_asset(width, height, 3, c.channels, noise(9 * c.channels));
    CompressSettings settings;
    settings.clusters = c.clusters;
    settings.components = c.components;
    settings.max_error = parse_compression_error(c.error);
    const PrtAsset read = written(scratch.folder(), asset, compress(asset, settings));
    ASSERT_EQ(read.clusters->count, c.clusters);
    const LightCoefficients light = light_coefficients(lights, 3, LightWindow::hann);
    RenderSettings render;
    render.width = 160;
    render.height = 120;
    render.supersample = 1;
    render.camera = "10,60";
    SceneView view = views_of(render, read.mesh.positions).front();
    view.look.albedo = albedo;
    const Image<float> gpu = test::drawn(read, light, view);
    const Image<float> cpu = relight_texels(read, light, albedo);

    // Decoding first and lighting then gives the CPU's result as well.
    const Image<float> plain = relight_texels(asset, light, albedo);
    double worst = 0, largest = 0, brightest = 0;
    const TransferSource source(asset);
    for (const std::uint32_t texel : source.covered())
      worst = std::max<double>(worst, std::abs(cpu.values()[3 * texel] - plain.values()[3 * texel]));

    for (int j = 0; j < view.height; ++j)
      for (int i = 0; i < view.width; ++i) {
        const Eigen::Vector3f ray = view.camera.pixel_direction(i, j, view.width, view.height);
        const Eigen::Vector3f point = view.camera.position - view.camera.position.y() / ray.y() * ray;
        if (std::max(std::abs(point.x()), std::abs(point.z())) > 0.495f) continue;
        const float x = (0.1f + 0.8f * (point.x() + 0.5f)) * width - 0.5f,
                    y = (0.1f + 0.8f * (0.5f - point.z())) * height - 0.5f;
        const int column = static_cast<int>(x), row = static_cast<int>(y);
        const float s = x - static_cast<float>(column), t = y - static_cast<float>(row);
        for (int color = 0; color < 3; ++color) {
          const float expected =
              (1 - t) * ((1 - s) * cpu.at(column, row, color) + s * cpu.at(column + 1, row, color)) +
              t * ((1 - s) * cpu.at(column, row + 1, color) + s * cpu.at(column + 1, row + 1, color));
          largest = std::max<double>(largest, std::abs(expected - gpu.at(i, j, color)));
          brightest = std::max<double>(brightest, std::abs(expected));
        }
      }
    // A software renderer filters 8-bit textures in 8 bits along one axis after the other, so that every plane is up to
    // half a step off twice, with weights of 8 bits; 16-bit ones in float. Texels are decoded one by one where clusters
    // meet.
    double steps = 0;
    for (const PlaneWeights& weights : cluster_weights(read, light, rgb_readers(read, albedo)))
      steps = std::max<double>(steps, weights.scales.cwiseAbs().colwise().maxCoeff().sum() / 255);
    SCOPED_TRACE(
        fmt::format("{} clusters, {} components, {} bits: GPU {:.5f}, steps {:.5f}, compression {:.5f} of {:.3f}",
                    c.clusters, c.components, read.bits, largest, steps, worst, brightest));
    EXPECT_LT(largest, (read.bits == 8 ? 2 * steps : 0) + 1e-4 * brightest);
    EXPECT_LT(worst, 0.05 * brightest);
  }
}

}  // namespace test_compress
}  // namespace kiln
