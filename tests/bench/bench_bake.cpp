// SPDX-License-Identifier: GPL-3.0-or-later
// Times the two bake backends on the Stanford bunny, in one run so that their ratio can be stated; receivers are the
// scan's own points. `items_per_second` is texel-directions per second.

#include <benchmark/benchmark.h>

#include "bake/bake.h"
#include "bake/egl/egl_engine.h"
#include "bake/rays/embree_engine.h"
#include "base/progress.h"
#include "import/import_mesh.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {
namespace {

constexpr char bunny_file[] = "/usr/share/glmark2/models/bunny.obj";

struct Scene {
  TriangleMesh bunny = load_mesh(bunny_file);
  Occluders occluders = join_occluders({bunny});
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 256, 1);

  TransferScene scene() const {
    return {occluders.mesh.positions, occluders.mesh.triangles, occluders.hull, occluders.closed};
  }
};

const Scene& bunny() {
  static const Scene scene;
  return scene;
}

void run(benchmark::State& state, TransferEngine& engine) {
  const Receivers receivers{bunny().bunny.positions, bunny().bunny.normals};
  for (auto _ : state) {
    engine.set_receivers(receivers, 5);
    engine.add(bunny().directions, no_progress);
    benchmark::DoNotOptimize(engine.sums());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * receivers.size() * bunny().directions.size()));
  state.SetLabel(engine.renderer());
}

void bake_embree(benchmark::State& state) {
  EmbreeEngine engine(bunny().scene(), rounding_offset(bunny().scene().positions));
  run(state, engine);
}

void bake_egl(benchmark::State& state) {
  ShadowMapSettings shadows;
  shadows.size_texels = static_cast<int>(state.range(0));
  EglEngine engine(bunny().scene(), "auto", 0, shadows);
  run(state, engine);
}

BENCHMARK(bake_embree)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(bake_egl)->Arg(512)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace kiln

BENCHMARK_MAIN();
