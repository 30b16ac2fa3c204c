// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "sh/transfer.h"
#include "table.h"

namespace kiln::extremes {

/// How a program ended.
struct Outcome {
  std::string program;
  int status = 0;      ///< exit status; 128 and the signal where one ended it
  std::string errors;  ///< what it wrote on stderr
  Json record;         ///< what it wrote on stdout with --json; null where it failed

  bool is_done() const { return status == 0; }
};

/// Kiln's programs, run in a scratch folder that goes with the object.
class Programs {
 public:
  Programs();
  ~Programs();
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;

  /// Returns a path in the scratch folder.
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  /// Makes a folder in the scratch folder, empty whatever it held.
  std::filesystem::path empty_folder(const std::string& name) const;

  /// Runs one of Kiln's programs with --quiet and --json.
  Outcome run(const std::string& program, const std::vector<std::string>& arguments) const;

 private:
  std::filesystem::path folder_;
};

/// Settings of the stages from a mesh to a baked asset.
struct Chain {
  int faces = 400;
  std::string size = "64";  ///< of the atlas
  int gutter = 2;
  int bands = 5;
  int directions = 256;
  bool has_detail = true;                ///< whether kiln-normals runs, else the low mesh itself receives
  std::vector<std::string> import = {};  ///< further arguments of all stages that read the high mesh
  std::string kept_uv = {};              ///< a low mesh with uvs, to keep in place of kiln-simplify's
};

/// What the stages made of a mesh: `outcome` is that of the first program that failed, or of the last.
struct Asset {
  std::filesystem::path folder;
  Outcome outcome;
  Json simplify, atlas, normals, bake;  ///< records of the stages that ran

  bool is_done() const { return outcome.is_done(); }
};

/// Takes a mesh through kiln-simplify, kiln-atlas, kiln-normals and kiln-bake (16 bits, Embree's rays), and then
/// kiln-check.
Asset make_asset(const Programs& programs, const std::string& name, const std::filesystem::path& high,
                 const Chain& chain = {});

/// Reads the transfer of the covered texels.
TransferVectors transfer_of(const Asset& asset);

/// Returns the largest difference of t_0 from that of an unoccluded texel.
double largest_shadow(const TransferVectors& transfer);

/// Returns whether all values are finite numbers, and no t_0 is above an unoccluded texel's by more than `slack`.
bool is_sane(const TransferVectors& transfer, double slack);

/// Makes a row for what must be refused with exit status 3 (or 2, for options), a message, and no output.
Row refusal(std::string what, std::string extreme, const Outcome& outcome, const std::filesystem::path& output,
            int status = 3);

/// Makes the row of something that failed and should not have.
Row failure(std::string what, std::string extreme, const Outcome& outcome);

}  // namespace kiln::extremes
