// SPDX-License-Identifier: MIT
// Combines light, albedo, ranges and bases of clusters into a constant and a scale for each stored value, as the
// runtime's plane_weights.cpp does: radiance = constant + sum over planes of scale * stored value (0 to 1).
import type { Coefficients } from './light';
import type { Manifest, Plane } from './manifest';

/** Texels of a row of the light's texture. */
export const lightWidth = 1024;

/** Where a plane went: its layer (the first of two where `deep`) and channel. */
export interface PlanePlace {
  plane: Plane;
  layer: number;
  channel: number;
  /** Stored in two layers, of high and of low bytes. */
  deep: boolean;
  /** What its stored values were multiplied by. */
  factor: number;
  /** Its layer has arrived. */
  ready: boolean;
}

/** Basis vectors of all clusters: rows of cluster * (components + 1), channels * coefficients wide. */
export interface ClusterTables {
  vectors: Float64Array;
  length: number;
}

/** Decodes the table of basis vectors; `stored` has its rows from the top. */
export function clusterTables(manifest: Manifest, stored: ArrayLike<number>): ClusterTables {
  const clusters = manifest.clusters!;
  const coefficients = manifest.bands * manifest.bands;
  const length = manifest.channels * coefficients;
  const vectors = new Float64Array(clusters.count * (clusters.components + 1) * length);
  for (let at = 0; at < vectors.length; ++at) {
    const { min, max } = clusters.vectorRanges[Math.floor(at / length) % (clusters.components + 1)];
    const scale = clusters.coefficientScales[(at % length) % coefficients];
    vectors[at] = (min + (stored[at] / 65535) * (max - min)) * scale;
  }
  return { vectors, length };
}

/** Returns how many texels the light of an asset takes. */
export function lightTexels(manifest: Manifest, layers: number): number {
  return (manifest.clusters?.count ?? 1) * (1 + 3 * layers);
}

/**
 * Fills the light's texture (RGBA): for each cluster the constant, then for each layer three texels: the scales of its
 * four channels for red, for green and for blue. Planes that have not arrived count as 0.
 */
export function fillLight(values: Float32Array, manifest: Manifest, places: readonly PlanePlace[], layers: number, tables: ClusterTables | null, light: Coefficients, albedo: readonly number[]): void {
  values.fill(0);
  const coefficients = manifest.bands * manifest.bands;
  const stride = 4 * (1 + 3 * layers);
  const count = manifest.clusters?.count ?? 1;
  const level = [0, 0, 0];
  const lit = (row: number, color: number) => {
    const begin = row * tables!.length + (manifest.channels === 3 ? color * coefficients : 0);
    let sum = 0;
    for (let i = 0; i < coefficients; ++i) sum += tables!.vectors[begin + i] * light[color][i];
    return sum * albedo[color];
  };
  for (let cluster = 0; cluster < count; ++cluster) {
    const begin = cluster * stride;
    const row = cluster * (places.length + 1);
    const constant = tables ? [lit(row, 0), lit(row, 1), lit(row, 2)] : [0, 0, 0];
    places.forEach(({ plane, layer, channel, deep, factor, ready }, j) => {
      if (!ready) return;
      for (let color = 0; color < 3; ++color) {
        if (tables) level[color] = lit(row + 1 + j, color);
        else level[color] = manifest.channels === 1 || plane.channel === color ? albedo[color] * light[color][plane.coefficient] : 0;
        constant[color] += level[color] * plane.min;
        const scale = (level[color] * (plane.max - plane.min)) / factor;
        const at = begin + 4 * (1 + 3 * layer + color) + channel;
        if (!deep) values[at] = scale;
        else {
          values[at] = (scale * 65280) / 65535;
          values[at + 12] = (scale * 255) / 65535;
        }
      }
    });
    values.set(constant, begin);
  }
}
