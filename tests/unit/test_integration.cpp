// SPDX-License-Identifier: GPL-3.0-or-later
// However a bake is cut (slabs, shards, checkpoints), its bits are the same; and it takes as many directions as its
// error needs.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "bake/backends.h"
#include "bake/bake.h"
#include "bake/integrate/error_driven.h"
#include "bake/integrate/integration.h"
#include "bake/planes/quantisation_floor.h"
#include "base/errors.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "import/import_mesh.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_integration {

namespace fs = std::filesystem;

/// A torus, whose inside shadows itself, and its vertices as receivers.
struct Content {
  TriangleMesh mesh = shapes::torus(36);
  Occluders occluders = join_occluders({mesh});
  ReceiverSet receivers;
  BakeSettings settings;

  Content() {
    receivers.positions = mesh.positions;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Eigen::Vector3f& p = mesh.positions[v];
      const Eigen::Vector3f ring = Eigen::Vector3f(p.x(), 0, p.z()).normalized();  // of radius 1
      receivers.normals.push_back((p - ring).normalized());
      receivers.slots.push_back(v);
    }
    receivers.width = static_cast<int>(mesh.positions.size());
    receivers.height = 1;
    settings.bands = 3;
    settings.directions = 300;  // not whole blocks
    settings.shadow_size = 128;
    settings.gl_device = "software";
  }
};

class Cuts : public testing::TestWithParam<BakeBackend> {
 protected:
  Cuts() { content.settings.backend = GetParam(); }
  BakeResult whole() const { return bake({content.receivers, content.occluders, content.settings, 7, 2}); }
  Content content;
  Scratch folder;
};

TEST_P(Cuts, SlabsGiveTheSameBits) {
  const BakeJob job{content.receivers, content.occluders, content.settings, 7, 2};
  Integration integration(job, 500);
  TransferVectors transfer(content.receivers.slots.size(), 9);
  integration.put_unoccluded(transfer);
  ASSERT_GT(integration.slabs(), 1u);
  for (std::size_t slab = 0; slab < integration.slabs(); ++slab)
    integration.put(slab, integration.sum(slab, {}, no_progress).sums, transfer);
  if (GetParam() == BakeBackend::beams || GetParam() == BakeBackend::mixed)
    // Other neighbours share a beam, and round a ray that passes an edge another way. Slabs have one size, always.
    EXPECT_LT(relative_l2(transfer, whole().channels.front()), 1e-4);
  else
    EXPECT_EQ(transfer.values, whole().channels.front().values);
}

TEST_P(Cuts, ShardsAddUpToTheSameBits) {
  std::vector<fs::path> folders;
  for (int index : {3, 1, 2}) {
    folders.push_back(folder / std::to_string(index));
    OutputSet outputs(folders.back());
    bake_shard(outputs, {index, 3}, {content.receivers, content.occluders, content.settings, 7, 2});
    outputs.commit();
  }
  const auto merge = [&](const std::vector<fs::path>& parts, const BakeSettings& settings, int seed) {
    return merge_shards(parts, {content.receivers, content.occluders, settings, seed, 2});
  };
  EXPECT_EQ(merge(folders, content.settings, 7).channels.front().values, whole().channels.front().values);
  BakeSettings by_error = content.settings;
  by_error.max_error = parse_error_target("0.05");
  std::vector<fs::path> by_error_folders;
  for (int index : {1, 2}) {
    by_error_folders.push_back(folder / ("by_error" + std::to_string(index)));
    OutputSet outputs(by_error_folders.back());
    bake_shard(outputs, {index, 2}, {content.receivers, content.occluders, by_error, 7, 2});
    outputs.commit();
  }
  const BakeResult merged = merge(by_error_folders, by_error, 7);
  const BakeResult at_once = bake({content.receivers, content.occluders, by_error, 7, 2});
  EXPECT_EQ(merged.directions, at_once.directions);
  EXPECT_EQ(merged.channels.front().values, at_once.channels.front().values);
  EXPECT_THROW(merge({folders[0], folders[1]}, content.settings, 7), BadInput);
  EXPECT_THROW(merge({folders[0], folders[1], folders[1]}, content.settings, 7), BadInput);
  EXPECT_THROW(merge(folders, content.settings, 8), BadInput);
  BakeSettings other = content.settings;
  other.bands = 4;
  EXPECT_THROW(merge(folders, other, 7), BadInput);
}

TEST_P(Cuts, NothingToTestIsStillABake) {
  // Points over a plane, looking up: all analytic.
  Content open;
  open.settings.backend = GetParam();
  open.occluders = join_occluders({shapes::plane(4)});
  for (std::size_t r = 0; r < open.receivers.positions.size(); ++r) {
    open.receivers.positions[r] = {0, 1 + 0.001f * static_cast<float>(r), 0};
    open.receivers.normals[r] = {0, 1, 0};
  }
  const BakeResult result = bake({open.receivers, open.occluders, open.settings, 7, 2});
  EXPECT_EQ(result.unoccluded, open.receivers.slots.size());
  EXPECT_NEAR(result.channels.front().plane(0)[5], 0.28209479, 1e-7);
  const fs::path shard = folder / "open";
  OutputSet outputs(shard);
  bake_shard(outputs, {1, 1}, {open.receivers, open.occluders, open.settings, 7, 2});
  outputs.commit();
  EXPECT_EQ(merge_shards({shard}, {open.receivers, open.occluders, open.settings, 7, 2}).channels.front().values,
            result.channels.front().values);
}

TEST(Unshadowed, IsTheClampedCosineOfEveryNormal) {
  // Points inside a closed sphere, which shadows them wholly: without shadows only their normals count.
  const Occluders occluders = join_occluders({shapes::icosphere(2)});
  ReceiverSet receivers;
  for (const Eigen::Vector3f& normal : {Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(0.6f, 0, 0.8f)}) {
    receivers.slots.push_back(static_cast<std::uint32_t>(receivers.slots.size()));
    receivers.positions.emplace_back(0, 0, 0);
    receivers.normals.push_back(normal);
  }
  receivers.width = receivers.height = 2;
  BakeSettings settings;
  settings.bands = 3;
  settings.casts_shadows = false;
  const BakeResult result = bake({receivers, occluders, settings});
  EXPECT_EQ(result.directions, 0);
  EXPECT_EQ(result.unoccluded, 2u);
  // Bands of the clamped cosine over pi are 1, 2/3 and 1/4 [Ramamoorthi 2001]; Y_1^1 is 0.488603 x.
  EXPECT_NEAR(result.channels.front().plane(0)[0], 0.28209479, 1e-6);
  EXPECT_NEAR(result.channels.front().plane(3)[0], 0, 1e-6);
  EXPECT_NEAR(result.channels.front().plane(3)[1], 0.48860251 * 2 / 3 * 0.6, 1e-6);
  EXPECT_NEAR(result.channels.front().plane(6)[0], 0.31539157 / 4 * 2, 1e-6);
}

TEST_P(Cuts, AnInterruptedBakeGoesOnToTheSameBits) {
  const Checkpoints first{folder / "checkpoint", 0, false};
  Checkpoints again = first;
  again.resume = true;
  int interruptions = 0;
  BakeResult result;
  for (Checkpoints checkpoints = first;; checkpoints = again) {
    int calls = 0;
    try {
      const auto interrupt = [&](double) {
        if (++calls > 1 && interruptions < 2) throw Interrupted();
      };
      result = bake({content.receivers, content.occluders, content.settings, 7, 2, checkpoints, interrupt});
      break;
    } catch (const Interrupted&) {
      ++interruptions;
      const SumsFile left = read_sums(first.folder / slab_name(0));
      EXPECT_GT(left.blocks_done, 0);
      EXPECT_LT(left.blocks_done, left.blocks_all);
    }
  }
  EXPECT_EQ(interruptions, 2);
  EXPECT_LT(result.work.pairs, content.receivers.slots.size() * 300);  // the rest alone
  EXPECT_EQ(result.channels.front().values, whole().channels.front().values);

  BakeSettings other = content.settings;
  other.directions = 301;
  EXPECT_THROW(bake({content.receivers, content.occluders, other, 7, 2, again}), BadInput);
}

TEST_P(Cuts, BouncesHaveTheSameBitsWhateverIsKeptOfRays) {
  content.occluders = join_occluders({content.mesh}, {SurfaceAlbedo::constant(Eigen::Vector3f{0.8f, 0.8f, 0.8f})});
  const bool is_egl = GetParam() == BakeBackend::egl;  // which casts no rays, and takes its time
  content.settings.bounces = {.count = is_egl ? 1 : 3};
  content.settings.bounce_edge = is_egl ? 0.2 : 0.05;
  if (is_egl) content.settings.directions = 96;
  const BakeResult kept = whole();
  const std::vector<float> values = kept.channels.front().values;
  EXPECT_EQ(kept.bounces->kept_bytes > 0, !is_egl);
  EXPECT_GT(kept.bounces->energy.back(), 1e-4);
  // Nothing, or what fits 1 MB.
  for (int megabytes : {0, 1}) {
    content.settings.bounce_memory = megabytes;
    const BakeResult less = whole();
    EXPECT_EQ(less.channels.front().values, values);
    EXPECT_EQ(less.bounces->energy, kept.bounces->energy);
    EXPECT_LE(less.bounces->kept_bytes, static_cast<std::size_t>(megabytes) * 1'000'000);
    if (!is_egl) {
      EXPECT_LT(less.bounces->kept_bytes, kept.bounces->kept_bytes);
    }
  }
  content.settings.bounce_memory = 512;

  // After the interruption of the direct light, only the rest of it is known.
  Checkpoints checkpoints{folder / "checkpoint", 0, false};
  int calls = 0;
  const auto interrupt = [&](double) {
    if (++calls > 1) throw Interrupted();
  };
  EXPECT_THROW(bake({content.receivers, content.occluders, content.settings, 7, 2, checkpoints, interrupt}),
               Interrupted);
  checkpoints.resume = true;
  const BakeResult resumed = bake({content.receivers, content.occluders, content.settings, 7, 2, checkpoints});
  EXPECT_EQ(resumed.channels.front().values, values);
  if (GetParam() == BakeBackend::beams) {
    EXPECT_LT(resumed.bounces->kept_bytes, kept.bounces->kept_bytes);
  }

  // Merged shards know nothing of their rays.
  std::vector<fs::path> parts;
  for (int index : {1, 2}) {
    parts.push_back(folder / ("bounced" + std::to_string(index)));
    OutputSet outputs(parts.back());
    bake_shard(outputs, {index, 2}, {content.receivers, content.occluders, content.settings, 7, 2});
    outputs.commit();
  }
  EXPECT_EQ(merge_shards(parts, {content.receivers, content.occluders, content.settings, 7, 2}).channels.front().values,
            values);
}

TEST_P(Cuts, ACheckpointHoldsForOtherStoring) {
  const Checkpoints first{folder / "checkpoint", 0, false};
  int calls = 0;
  const auto interrupt = [&](double) {
    if (++calls > 1) throw Interrupted();
  };
  EXPECT_THROW(bake({content.receivers, content.occluders, content.settings, 7, 2, first, interrupt}), Interrupted);
  Checkpoints again = first;
  again.resume = true;
  BakeSettings other = content.settings;
  other.bands = 4;
  EXPECT_THROW(bake({content.receivers, content.occluders, other, 7, 2, again}), BadInput);
  other = content.settings;
  other.seams = SeamChoice::keep;
  other.bits = 16;
  const BakeResult resumed = bake({content.receivers, content.occluders, other, 7, 2, again});
  EXPECT_LT(resumed.work.pairs, content.receivers.slots.size() * 300);  // the rest alone
  EXPECT_EQ(resumed.channels.front().values, whole().channels.front().values);
}

TEST(BakeOptions, SayWhatTheyAffect) {
  BakeSettings settings;
  const OptionSet options = bake_options(settings);
  for (const Option& option : options.options())
    EXPECT_TRUE(option.affects) << option.name << " of the bake: sums, the plan of them, storing or the check?";
  const auto affects = [&](const char* name) { return options.find(name)->affects; };
  for (const char* name : {"bands", "ray-offset", "sampling", "place", "shadow-size", "buried", "weld"})
    EXPECT_EQ(affects(name), Affects::sums) << name;
  for (const char* name : {"seams", "bits", "bounces", "albedo", "bake-albedo", "subsurface", "subsurface-eta"})
    EXPECT_EQ(affects(name), Affects::storing) << name;
  EXPECT_EQ(affects("verify-texels"), Affects::verifying);
  EXPECT_EQ(affects("backend"), Affects::plan);
}

INSTANTIATE_TEST_SUITE_P(Integration, Cuts,
                         testing::Values(BakeBackend::egl, BakeBackend::mixed, BakeBackend::beams, BakeBackend::embree),
                         [](const auto& backend) { return backend_name(backend.param); });

TEST(SumsFile, RoundTripsAndRefusesWhatIsNotWhole) {
  const Scratch folder;
  SumsFile file;
  file.key = R"({"what":"a test"})";
  file.first_receiver = 5;
  file.blocks_done = 2;
  file.blocks_all = 3;
  file.sums = TransferSums(2, 4);
  for (std::size_t k = 0; k < 8; ++k) file.sums.values[k] = (k % 2 == 0 ? 1 : -1) * (std::int64_t{1} << (8 * k - k));
  file.sums.directions = 64;
  const fs::path path = folder / "sums";
  write_sums(path, file);
  const SumsFile read = read_sums(path);
  EXPECT_EQ(read.key, file.key);
  EXPECT_EQ(read.first_receiver, 5u);
  EXPECT_EQ(read.sums.values, file.sums.values);
  EXPECT_EQ(read.sums.directions, 64);
  EXPECT_FALSE(read.complete());

  const std::uintmax_t size = fs::file_size(path);
  const auto damaged = [&](auto damage) {
    write_sums(path, file);
    damage();
    EXPECT_THROW(read_sums(path), BadInput);
  };
  damaged([&] { fs::resize_file(path, size - 1); });
  damaged([&] { fs::resize_file(path, 10); });
  damaged([&] { fs::resize_file(path, 0); });
  damaged([&] { std::ofstream(path) << "solid cube\n"; });
  damaged([&] { std::ofstream(path) << "{\"format\": \"kiln-sums\"}\n"; });
  damaged([&] {
    std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(size) - 3);
    stream.put('\x55');
  });
  EXPECT_THROW(read_sums(folder / "none"), BadInput);
}

TEST(ErrorDriven, ReadsItsOptions) {
  EXPECT_FALSE(parse_error_target("none").wanted);
  EXPECT_TRUE(parse_error_target("auto").floor);
  EXPECT_DOUBLE_EQ(parse_error_target("0.004").error, 0.004);
  for (const char* wrong : {"", "0", "1", "-0.1", "0.1x", "nan", "inf", "often"})
    EXPECT_THROW(parse_error_target(wrong), WrongUsage) << wrong;
  EXPECT_EQ(parse_shard("2/3").index, 2);
  EXPECT_EQ(parse_shard("2/3").count, 3);
  for (const char* wrong : {"", "1", "0/3", "4/3", "1/", "/3", "1/3x", "a/b", "-1/3"})
    EXPECT_THROW(parse_shard(wrong), WrongUsage) << wrong;
}

TEST(ErrorDriven, TheFloorIsWhatStoringCosts) {
  // Values that fill a range evenly, as the formula supposes.
  TransferVectors transfer(4096, 4), stored(4096, 4);
  for (int i = 0; i < 4; ++i) {
    for (std::size_t r = 0; r < 4096; ++r) transfer.plane(i)[r] = static_cast<float>((r * 2654435761u % 4096) / 4095.0);
    const double step = 1.0 / 255;
    for (std::size_t r = 0; r < 4096; ++r)
      stored.plane(i)[r] = static_cast<float>(step * std::round(transfer.plane(i)[r] / step));
  }
  EXPECT_NEAR(quantisation_floor(transfer, 8), relative_l2(stored, transfer), 0.05 * quantisation_floor(transfer, 8));
}

TEST(ErrorDriven, StopsAtAnErrorThatRaysConfirm) {
  Content content;
  content.mesh = load_mesh("/usr/share/glmark2/models/bunny.obj");
  content.occluders = join_occluders({content.mesh});
  content.receivers = {};
  for (std::size_t v = 0; v < content.mesh.positions.size(); v += 20) {
    content.receivers.slots.push_back(static_cast<std::uint32_t>(content.receivers.slots.size()));
    content.receivers.positions.push_back(content.mesh.positions[v]);
    content.receivers.normals.push_back(content.mesh.normals[v]);
  }
  BakeSettings settings;
  settings.backend = BakeBackend::embree;
  BakeSettings truth_settings = settings;
  truth_settings.directions = 16384;  // about a tenth of the errors below
  const TransferVectors truth = bake({content.receivers, content.occluders, truth_settings, 99, 2}).channels.front();
  int before = 0;
  for (const char* target : {"0.03", "0.01"}) {
    settings.max_error = parse_error_target(target);
    const BakeResult result = bake({content.receivers, content.occluders, settings, 1, 2});
    ASSERT_TRUE(result.choice);
    EXPECT_LE(result.choice->estimated_error, std::stod(target));
    EXPECT_EQ(result.sampling, Sampling::progressive);
    EXPECT_EQ(result.directions % block_directions, 0);
    EXPECT_GT(result.directions, before);
    before = result.directions;
    const double error = relative_l2(result.channels.front(), truth);
    EXPECT_LT(error, std::stod(target));
    // The set is hardly larger than needed: by a factor of 2 at most.
    EXPECT_GT(error, 0.3 * result.choice->estimated_error);
  }
  settings.max_error = parse_error_target("1e-6");
  settings.max_directions = 100;
  const BakeResult limited = bake({content.receivers, content.occluders, settings, 1, 2});
  EXPECT_EQ(limited.directions, 100);
  EXPECT_GT(limited.choice->estimated_error, limited.choice->target_error);
}

}  // namespace test_integration
}  // namespace kiln
