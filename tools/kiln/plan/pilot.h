// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kiln/overrides.h"
#include "kiln/pipeline.h"
#include "kiln/plan/asset_model.h"

namespace kiln {

/// Small builds of assets that a plan measures, in folders of their own: the driver's rule, that content decides,
/// reuses them for the next plan.
class PilotBuilds {
 public:
  /// `folder` holds all builds.
  PilotBuilds(const Pipeline& pipeline, std::filesystem::path folder, int jobs, bool quiet);

  /// Builds the pilots of all assets. `is_kept` lists settings that stay as the pipeline has them. Throws BadInput,
  /// naming the asset, where a build fails; its stage has said why.
  std::map<std::string, Pilot> build(const std::vector<const Asset*>& assets, const std::vector<std::string>& kept);

  /// Builds the fine pilot of one asset anew with so many bands, compressed, as PilotBuild of `Pilot::compressed`.
  PilotBuild build_compressed(const Asset& asset, int bands, double max_error, const std::vector<std::string>& kept);

  /// Returns how often light bounces in the fine pilot of an asset.
  int bounces_of(const std::string& asset) const;

  /// CPU seconds of all stages of these builds, those of earlier plans included.
  double cpu_seconds() const { return cpu_seconds_; }

 private:
  Pipeline pipeline_at(const std::string& name, const Overrides& overrides, bool compressed,
                       const std::vector<std::string>& kept) const;
  std::vector<PilotBuild> build_at(const std::string& name, const std::vector<const Asset*>& assets,
                                   const Overrides& overrides, bool compressed, const std::vector<std::string>& kept);
  bool enlarge_missing_atlases(const Pipeline& there, const std::vector<std::string>& names);

  const Pipeline& pipeline_;
  const std::filesystem::path folder_;
  const int jobs_;
  const bool quiet_;
  std::map<std::string, int> atlas_factors_;  ///< by asset: how many times larger its pilots' atlases have to be
  double cpu_seconds_ = 0;
};

/// Tells whether an asset may have a setting of the bake: whether none of its stages, settings and budgets forbids it.
bool allows(const Asset& asset, const std::string& setting, const std::string& value);

/// Tells whether the bake of an asset has shadows as the pipeline has it.
bool has_shadows(const Asset& asset);

/// Tells whether light bounces in an asset as the pipeline has it.
bool has_bounces(const Asset& asset);

}  // namespace kiln
