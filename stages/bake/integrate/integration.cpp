// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/integrate/integration.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "bake/backends.h"
#include "bake/integrate/unoccluded.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "raycast/beam_transfer.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t pilot_receivers = 4096;
constexpr double step_seconds = 1;  // time between two chances to stop

/// Receivers spread evenly over a list.
struct Sample {
  std::vector<Eigen::Vector3f> positions, normals;
};

Sample sample_of(const Receivers& receivers, std::span<const std::uint32_t> indices) {
  Sample sample;
  const std::size_t count = std::min(pilot_receivers, indices.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t r = indices[k * indices.size() / count];
    sample.positions.push_back(receivers.positions[r]);
    sample.normals.push_back(receivers.normals[r]);
  }
  return sample;
}

/// Returns the shard's directions, whole blocks; only the last of all blocks may be smaller.
std::vector<Eigen::Vector3f> shard_directions(std::span<const Eigen::Vector3f> all, const Shard& shard) {
  std::vector<Eigen::Vector3f> own;
  for (std::size_t block = 0; block * block_directions < all.size(); ++block) {
    if (static_cast<int>(block % static_cast<std::size_t>(shard.count)) != shard.index - 1) continue;
    const std::size_t first = block * block_directions;
    const auto part = all.subspan(first, std::min<std::size_t>(block_directions, all.size() - first));
    own.insert(own.end(), part.begin(), part.end());
  }
  return own;
}

std::int64_t blocks_of(std::size_t directions) {
  return static_cast<std::int64_t>((directions + block_directions - 1) / block_directions);
}

/// Takes up the sums that an earlier run left, if there are any. Throws BadInput where they are of another bake.
void take_up(const fs::path& path, SumsFile& file) {
  if (!fs::exists(path)) return;
  SumsFile earlier = read_sums(path);
  if (earlier.key != file.key || earlier.first_receiver != file.first_receiver ||
      earlier.sums.values.size() != file.sums.values.size() || earlier.blocks_all != file.blocks_all)
    throw BadInput(path.string(), "is a checkpoint of a bake with other inputs or settings", "one of the same command",
                   "repeat that command, or bake without --resume");
  file = std::move(earlier);
}

/// Chooses how many blocks the next step integrates, so that it takes about a second.
std::int64_t next_step(std::int64_t blocks, double seconds) {
  if (seconds < step_seconds / 2) return 2 * blocks;
  return seconds > 2 * step_seconds ? std::max<std::int64_t>(1, blocks / 2) : blocks;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, failure] = std::from_chars(text.data(), end, shard.index);
  if (failure == std::errc{} && slash != end && *slash == '/') {
    const auto [last, second_failure] = std::from_chars(slash + 1, end, shard.count);
    if (second_failure == std::errc{} && last == end && 1 <= shard.index && shard.index <= shard.count) return shard;
  }
  throw WrongUsage("shard: found '" + text + "'; expected K/N with 1 <= K <= N");
}

std::string slab_name(std::size_t slab) {
  std::string number = std::to_string(slab);
  return "slab_" + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number + ".sums";
}

Integration::Integration(const BakeJob& job, std::size_t slab_receivers)
    : job_(job),
      receivers_(job.receivers.view()),
      slab_receivers_(slab_receivers),
      backend_(choose_backend(job.settings)),
      sampling_(job.settings.sampling) {
  const BakeSettings& settings = job.settings;
  const Occluders& occluders = job.occluders;

  // Step 1: find the receivers that something may shadow.
  const float lift = ray_offset_of(settings, occluders.hull);
  const std::vector<std::uint8_t> unoccluded = unoccluded_receivers(occluders.hull, receivers_, lift);
  for (std::uint32_t r = 0; r < receivers_.size(); ++r)
    if (unoccluded[r] == 0) tested_.push_back(r);

  // Step 2: choose the directions. For a target error, rays may decide in place of a software renderer, which would
  // draw all depth maps for a few thousand receivers: the two halves that are compared share their errors of
  // visibility.
  int count = settings.directions;
  if (settings.max_error.wanted) {
    sampling_ = Sampling::progressive;
    if (!tested_.empty()) {
      const Sample sample = sample_of(receivers_, tested_);
      std::unique_ptr<TransferEngine> rays;
      if (backend_ == BakeBackend::egl && engine().is_software())
        rays = make_engine(BakeBackend::beams, occluders, settings, job.threads);
      choice_ = choose_directions(rays ? *rays : engine(), {sample.positions, sample.normals}, job);
      count = choice_->directions;
    } else {
      count = block_directions;  // the fewest: every receiver has its analytic transfer
    }
  }
  directions_ = sample_directions(sampling_, count, static_cast<std::uint64_t>(job.seed));
  order_coherently(directions_, block_directions);

  // Step 3: hash what tells the sums of this bake from others.
  receivers_hash_ = hash_points({receivers_.positions, receivers_.normals});
  occluders_hash_ = hash_points({occluders.mesh.positions}) + hash_triangles(occluders.mesh.triangles);
}

TransferEngine& Integration::engine() {
  if (engine_) return *engine_;
  BakeSettings settings = job_.settings;
  if (backend_ == BakeBackend::egl && settings.shadow_size == 0) {
    if (!tested_.empty()) {
      const Sample sample = sample_of(receivers_, tested_);
      shadow_choice_ = choose_shadow_size({sample.positions, sample.normals}, job_);
    }
    settings.shadow_size = shadow_choice_ ? shadow_choice_->size_texels : 256;  // any size will do: nothing is shadowed
  }
  engine_ = make_engine(backend_, job_.occluders, settings, job_.threads);
  return *engine_;
}

std::size_t Integration::slabs() const {
  // Count one slab even where nothing is tested, so that a shard always has a file.
  return std::max<std::size_t>(1, (tested_.size() + slab_receivers_ - 1) / slab_receivers_);
}

Integration::Slab Integration::gather(std::size_t slab) const {
  Slab gathered;
  gathered.first = slab * slab_receivers_;
  const std::size_t count = std::min(slab_receivers_, tested_.size() - gathered.first);
  gathered.positions.reserve(count);
  gathered.normals.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    gathered.positions.push_back(receivers_.positions[tested_[gathered.first + k]]);
    gathered.normals.push_back(receivers_.normals[tested_[gathered.first + k]]);
  }
  return gathered;
}

std::string Integration::key(const Shard& shard, const std::string& renderer) const {
  BakeSettings settings = job_.settings;
  settings.sampling = sampling_;
  if (shadow_choice_) settings.shadow_size = shadow_choice_->size_texels;
  Json relevant = Json::object();
  const OptionSet options = bake_options(settings);
  for (const Option& option : options.options())
    if (option.affects.value_or(Affects::sums) == Affects::sums) relevant[option.name] = option.get();
  const Json key = {{"receivers", receivers_hash_},
                    {"occluders", occluders_hash_},
                    {"settings", relevant},
                    {"backend", backend_name(backend_)},
                    {"renderer", renderer},
                    {"directions", directions_.size()},
                    {"seed", job_.seed},
                    {"slab_receivers", slab_receivers_},
                    {"shard", std::to_string(shard.index) + "/" + std::to_string(shard.count)}};
  return json_text(key);
}

SumsFile Integration::sum(std::size_t slab, const Shard& shard, const ProgressFunction& progress) {
  const Checkpoints& checkpoints = job_.checkpoints;
  const Slab own = gather(slab);
  const std::vector<Eigen::Vector3f> directions = shard_directions(directions_, shard);
  SumsFile file;
  file.key = key(shard, engine().renderer());
  file.first_receiver = own.first;
  file.blocks_all = blocks_of(directions.size());
  file.sums = TransferSums(own.positions.size(), coefficient_count(job_.settings.bands));
  if (own.positions.empty()) {
    file.blocks_done = file.blocks_all;
    file.sums.directions = static_cast<std::int64_t>(directions.size());
    return file;
  }
  const fs::path path = checkpoints.folder / slab_name(slab);

  // Step 1: take up what an earlier run left.
  if (checkpoints.resume && !checkpoints.folder.empty()) take_up(path, file);
  if (file.complete()) return file;

  // Step 2: integrate in steps of about a second, each of whole blocks, with a checkpoint now and then.
  engine().keep_blocked(memory_);
  engine().set_receivers({own.positions, own.normals}, job_.settings.bands);
  const std::int64_t blocks_before = file.blocks_done;
  std::int64_t blocks_added = 0, step_blocks = 1;
  bool interrupted = false;
  Stopwatch since_checkpoint;
  const auto current = [&] {
    SumsFile now = file;
    now.sums.add(engine().sums());
    now.blocks_done = blocks_before + blocks_added;
    return now;
  };
  while (blocks_before + blocks_added < file.blocks_all) {
    const std::int64_t first = blocks_before + blocks_added;
    const std::int64_t count = std::min(step_blocks, file.blocks_all - first);
    const auto begin = static_cast<std::size_t>(first * block_directions);
    const std::size_t size = std::min(static_cast<std::size_t>(count * block_directions), directions.size() - begin);
    const Stopwatch stopwatch;
    const auto all = static_cast<double>(file.blocks_all);
    const ProgressFunction part =
        part_of(progress, static_cast<double>(first) / all, static_cast<double>(first + count) / all);
    engine().add(std::span(directions).subspan(begin, size), [&](double fraction) {
      try {
        part(fraction);
      } catch (const Interrupted&) {
        interrupted = true;  // stop after this step, whose sums are then whole
      }
    });
    blocks_added += count;
    step_blocks = next_step(step_blocks, stopwatch.seconds());
    const bool due = since_checkpoint.seconds() >= checkpoints.seconds;
    if (!checkpoints.folder.empty() && (due || interrupted)) {
      fs::create_directories(checkpoints.folder);
      write_sums(path, current());
      since_checkpoint = Stopwatch();
    }
    if (interrupted) throw Interrupted();
  }
  blocked_.resize(slabs());
  blocked_[slab] = engine().take_blocked();
  blocked_[slab].start_at(static_cast<std::size_t>(blocks_before));
  return current();
}

std::vector<TracedReceivers> Integration::take_traced() {
  blocked_.resize(slabs());
  std::vector<TracedReceivers> traced(slabs());
  for (std::size_t slab = 0; slab < slabs(); ++slab) {
    const Slab own = gather(slab);
    traced[slab].order = packet_order({own.positions, own.normals});
    for (std::uint32_t& receiver : traced[slab].order) receiver = tested_[own.first + receiver];
    traced[slab].blocked = std::move(blocked_[slab]);
  }
  blocked_.clear();
  return traced;
}

void Integration::put(std::size_t slab, const TransferSums& sums, TransferVectors& transfer) const {
  if (sums.directions != static_cast<std::int64_t>(directions_.size()))
    throw std::logic_error("a slab's sums lack directions");
  const TransferVectors own = sums.transfer();
  const std::size_t first = slab * slab_receivers_;
  for (int i = 0; i < own.coefficients; ++i)
    for (std::size_t k = 0; k < own.receivers; ++k) transfer.plane(i)[tested_[first + k]] = own.plane(i)[k];
}

void Integration::put_unoccluded(TransferVectors& transfer) const {
  const ShBasis basis(job_.settings.bands);
  std::size_t next = 0;
  for (std::uint32_t r = 0; r < receivers_.size(); ++r) {
    if (next < tested_.size() && tested_[next] == r) {
      ++next;
      continue;
    }
    const std::vector<float> values = unoccluded_transfer(basis, receivers_.normals[r]);
    for (int i = 0; i < basis.size(); ++i) transfer.plane(i)[r] = values[i];
  }
}

}  // namespace kiln
