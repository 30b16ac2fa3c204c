// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/stored_pca.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/parallel.h"
#include "compress/chunks.h"

namespace kiln {

namespace {

constexpr double most_steps = 65535;

/// Returns the matrices (B^T B)^-1 B^T of all clusters, which turn the vector of a texel into weights.
std::vector<Eigen::MatrixXf> fitting_matrices(const PcaModel& model) {
  std::vector<Eigen::MatrixXf> result;
  for (const Eigen::MatrixXf& basis : model.bases) {
    const Eigen::MatrixXd exact = basis.cast<double>(), square = exact.transpose() * exact;
    const Eigen::MatrixXd fit = square.ldlt().solve(exact.transpose());
    result.emplace_back(fit.cast<float>());
  }
  return result;
}

/// Calls `body` once per cluster with the cluster's number and the indices of its columns among `vectors`, which are
/// those of `texels`.
void for_each_cluster(const TexelModel& model, std::span<const std::uint32_t> texels,
                      const std::function<void(std::size_t, const std::vector<Eigen::Index>&)>& body) {
  std::vector<std::vector<Eigen::Index>> columns(model.model.means.size());
  for (std::size_t k = 0; k < texels.size(); ++k) columns[model.ids[texels[k]]].push_back(static_cast<Eigen::Index>(k));
  for (std::size_t cluster = 0; cluster < columns.size(); ++cluster)
    if (!columns[cluster].empty()) body(cluster, columns[cluster]);
}

/// Returns the weights, components x texels.
Eigen::MatrixXf fitted_weights(const TexelModel& model, const std::vector<Eigen::MatrixXf>& fits,
                               const Eigen::MatrixXf& vectors, std::span<const std::uint32_t> texels) {
  Eigen::MatrixXf weights(model.model.components, vectors.cols());
  for_each_cluster(model, texels, [&](std::size_t cluster, const std::vector<Eigen::Index>& columns) {
    const Eigen::MatrixXf centred = vectors(Eigen::all, columns).colwise() - model.model.means[cluster];
    weights(Eigen::all, columns) = fits[cluster] * centred;
  });
  return weights;
}

/// Returns the steps of the means' entries and of those of each basis vector.
std::vector<double> vector_steps(const PcaModel& model, const TransferSource& source, const PrincipalComponents& all,
                                 double step) {
  const double share = model.clusters() == 1 ? 1.0 / 16 : 1.0 / 4;  // one basis costs next to nothing
  std::vector<double> steps = {share * step};
  for (int j = 0; j < model.components; ++j) {
    const double deviation = std::sqrt(all.variances[j] / static_cast<double>(source.covered().size()));
    steps.push_back(share * step / std::max(deviation, step));
  }
  return steps;
}

}  // namespace

std::vector<std::uint32_t> gutter_owners(const TransferSource& source, int gutter) {
  const int width = source.asset().width, height = source.asset().height;
  std::vector<std::uint32_t> owners(source.coverage().size(), no_owner);
  for (const std::uint32_t texel : source.covered()) owners[texel] = texel;
  for (int ring = 0; ring < gutter; ++ring) {
    const std::vector<std::uint32_t> before = owners;
    parallel_for(0, height, [&](int j) {
      for (int i = 0; i < width; ++i) {
        std::uint32_t& owner = owners[static_cast<std::size_t>(j) * width + i];
        // Neighbours across an edge come first, then those across a corner.
        for (const auto& [x, y] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
          if (owner != no_owner) break;
          if (i + x >= 0 && i + x < width && j + y >= 0 && j + y < height)
            owner = before[static_cast<std::size_t>(j + y) * width + i + x];
        }
      }
    });
  }
  return owners;
}

TexelModel texel_model(const TransferSource& source, const PcaModel& one, const std::vector<std::uint32_t>& owners) {
  return {one, std::vector<std::uint8_t>(source.coverage().size(), 0), owners};
}

TexelModel texel_model(const TransferSource& source, const ClusteredPca& clustered,
                       const std::vector<std::uint32_t>& owners) {
  TexelModel result = texel_model(source, clustered.model, owners);
  for (std::size_t k = 0; k < source.covered().size(); ++k) result.ids[source.covered()[k]] = clustered.ids[k];
  const auto width = static_cast<std::size_t>(source.asset().width);
  for (std::size_t texel = 0; texel < owners.size(); ++texel)
    if (owners[texel] != no_owner)
      result.ids[texel] = result.ids[owners[texel]];
    else if (texel % width > 0)
      result.ids[texel] = result.ids[texel - 1];
  return result;
}

int StoredPicture::largest() const { return *std::max_element(values.values().begin(), values.values().end()); }

PcaModel rounded_model(const PcaModel& model, const TransferSource& source, const PrincipalComponents& all, double step,
                       StoredPca* stored) {
  PcaModel rounded = model;
  const std::vector<double> steps = vector_steps(model, source, all, step);
  const int rows = model.clusters() * (model.components + 1);
  if (stored != nullptr) stored->vectors = Image<std::uint16_t>(source.length(), rows, 1);
  for (int j = 0; j <= model.components; ++j) {
    // Row j of every cluster has one common range.
    const auto row = [&](std::size_t cluster) {
      float* first = j == 0 ? rounded.means[cluster].data() : rounded.bases[cluster].col(j - 1).data();
      return Eigen::Map<Eigen::VectorXf>(first, source.length());
    };
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t c = 0; c < model.means.size(); ++c) {
      lowest = std::min<double>(lowest, row(c).minCoeff());
      highest = std::max<double>(highest, row(c).maxCoeff());
    }
    const double step_j = std::max(steps[static_cast<std::size_t>(j)], (highest - lowest) / most_steps);
    const double unit = step_j > 0 ? step_j : 1;
    if (stored != nullptr) stored->vector_rows.push_back({{}, 16, PlaneRange::of_steps(lowest, unit, 16)});
    for (std::size_t c = 0; c < model.means.size(); ++c) {
      Eigen::Map<Eigen::VectorXf> values = row(c);
      for (int i = 0; i < values.size(); ++i) {
        const double place = std::min(std::round((values[i] - lowest) / unit), most_steps);
        values[i] = static_cast<float>(lowest + place * unit);
        if (stored != nullptr)
          stored->vectors.at(i, rows - 1 - (static_cast<int>(c) * (model.components + 1) + j)) =
              static_cast<std::uint16_t>(place);
      }
    }
  }
  return rounded;
}

VectorErrors vector_errors(const TexelModel& decoded, double step) {
  return [&decoded, fits = fitting_matrices(decoded.model), unit = static_cast<float>(step)](
             Eigen::Ref<Eigen::MatrixXf> vectors, std::span<const std::uint32_t> texels) {
    for_each_cluster(decoded, texels, [&](std::size_t cluster, const std::vector<Eigen::Index>& columns) {
      Eigen::MatrixXf part = vectors(Eigen::all, columns).colwise() - decoded.model.means[cluster];
      Eigen::MatrixXf weights = fits[cluster] * part;
      if (unit > 0) weights = unit * (weights.array() / unit).round();
      part.noalias() -= decoded.model.bases[cluster] * weights;
      vectors(Eigen::all, columns) = part;
    });
  };
}

TexelErrors stored_errors(const TransferSource& source, const TexelModel& decoded, double step) {
  return [&source, errors = vector_errors(decoded, step)](std::span<const std::uint32_t> texels) {
    Eigen::MatrixXf vectors = source.vectors(texels);
    errors(vectors, texels);
    return vectors;
  };
}

StoredPca store_pca(const TransferSource& source, const TexelModel& model, const PrincipalComponents& all,
                    double step) {
  StoredPca stored;
  stored.decoded = model;
  stored.decoded.model = rounded_model(model.model, source, all, step, &stored);
  const std::vector<Eigen::MatrixXf> fits = fitting_matrices(stored.decoded.model);
  std::vector<std::uint32_t> kept;  // texels with values of their own
  for (std::size_t texel = 0; texel < model.owners.size(); ++texel)
    if (model.owners[texel] != no_owner) kept.push_back(static_cast<std::uint32_t>(texel));
  const auto weights_of = [&](std::size_t first, std::size_t count) {
    const std::span<const std::uint32_t> part = std::span(kept).subspan(first, count);
    return fitted_weights(stored.decoded, fits, source.vectors(part), part);
  };

  // Compute ranges first; then the values again, so that no float planes need memory.
  const int components = model.model.components;
  std::vector<Eigen::VectorXf> least((kept.size() + chunk_texels - 1) / chunk_texels), most = least;
  for_each_chunk(kept.size(), [&](std::size_t first, std::size_t count) {
    const Eigen::MatrixXf weights = weights_of(first, count);
    least[first / chunk_texels] = weights.rowwise().minCoeff();
    most[first / chunk_texels] = weights.rowwise().maxCoeff();
  });
  std::vector<double> units;
  for (int j = 0; j < components; ++j) {
    double lowest = least[0][j], highest = most[0][j];
    for (std::size_t chunk = 1; chunk < least.size(); ++chunk) {
      lowest = std::min<double>(lowest, least[chunk][j]);
      highest = std::max<double>(highest, most[chunk][j]);
    }
    const double unit = std::max(step, (highest - lowest) / most_steps);
    // Use whole steps from zero, which is what rounding was measured with.
    lowest = unit * std::round(lowest / unit);
    const double steps = std::round((highest - lowest) / unit);
    const int bits = steps > 255 ? 16 : 8;
    stored.weights.push_back({Image<std::uint16_t>(source.asset().width, source.asset().height, 1), bits,
                              PlaneRange::of_steps(lowest, unit, bits)});
    units.push_back(unit);
  }
  for_each_chunk(kept.size(), [&](std::size_t first, std::size_t count) {
    const Eigen::MatrixXf weights = weights_of(first, count);
    for (int j = 0; j < components; ++j) {
      StoredPicture& plane = stored.weights[static_cast<std::size_t>(j)];
      const double top = PlaneRange::largest_stored(plane.bits);
      for (std::size_t k = 0; k < count; ++k)
        plane.values.values()[kept[first + k]] = static_cast<std::uint16_t>(
            std::clamp(std::round((weights(j, static_cast<Eigen::Index>(k)) - plane.range.lowest) /
                                  units[static_cast<std::size_t>(j)]),
                       0.0, top));
    }
  });

  // Texels that no lookup reaches repeat their left neighbour.
  const auto width = static_cast<std::size_t>(source.asset().width);
  for (StoredPicture& plane : stored.weights)
    for (std::size_t texel = 0; texel < model.owners.size(); ++texel)
      if (model.owners[texel] == no_owner && texel % width > 0)
        plane.values.values()[texel] = plane.values.values()[texel - 1];
  return stored;
}

}  // namespace kiln
