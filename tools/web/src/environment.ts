// SPDX-License-Identifier: MIT
// Equirectangular pictures as light: u = atan2(z, x) / 2 pi + 1/2, v = elevation / pi + 1/2 (docs/format.md, "Light").
import { DataUtils, FloatType, HalfFloatType, type DataTexture } from 'three';
import { evaluateBasis, HarmonicRotation } from './harmonics';
import type { Coefficients } from './light';

/** Linear radiance, rows from the bottom (v = 0, the nadir) unless `topFirst`. */
export interface RadiancePicture {
  width: number;
  height: number;
  /** Numbers of a pixel: 3 or 4. */
  stride: number;
  data: ArrayLike<number>;
  /** Turns a number of `data` into radiance. */
  decode: (value: number) => number;
  topFirst: boolean;
}

const pictures = new WeakMap<object, { version: number; picture: RadiancePicture }>();

/** Reads the texture of HDRLoader or EXRLoader; of any other data texture in float or half float. */
export function radianceOf(texture: DataTexture): RadiancePicture {
  const image = texture.image as { width: number; height: number; data: ArrayLike<number> | null } | undefined;
  const known = pictures.get(texture);
  if (known && known.version === texture.version) return known.picture;
  const data = image?.data;
  if (!image || !data || (texture.type !== FloatType && texture.type !== HalfFloatType))
    throw new TypeError('kiln: an environment must be an equirectangular data texture of floats, as HDRLoader and EXRLoader make them');
  const picture: RadiancePicture = {
    width: image.width,
    height: image.height,
    stride: data.length / (image.width * image.height),
    data,
    decode: texture.type === HalfFloatType ? (value) => DataUtils.fromHalfFloat(value) : (value) => value,
    topFirst: texture.flipY,
  };
  pictures.set(texture, { version: texture.version, picture });
  return picture;
}

/**
 * Projects a picture: the sum over its pixels, each cut into at least as many parts as make 256 rows, of radiance times
 * the harmonics at the part's middle times its solid angle. The pole of the sums is +Y, so that sines and cosines of the
 * azimuth serve a whole column.
 */
export function projectPicture(picture: RadiancePicture, bands: number): Coefficients {
  const { width, height, stride, data, decode, topFirst } = picture;
  const parts = Math.max(1, Math.ceil(256 / height));
  const waves = azimuthWaves(width, bands, parts);
  const sums = [0, 1, 2].map(() => new Float64Array(bands * bands));
  const row = new Float64Array(3 * (2 * bands - 1));
  for (let j = 0; j < height; ++j) {
    const begin = (topFirst ? height - 1 - j : j) * width * stride;
    row.fill(0);
    for (let i = 0; i < width; ++i)
      for (let c = 0; c < 3; ++c) {
        const value = decode(data[begin + i * stride + c]);
        if (!Number.isFinite(value) || value <= 0) continue;
        for (let k = 0; k < 2 * bands - 1; ++k) row[c * (2 * bands - 1) + k] += value * waves[i * (2 * bands - 1) + k];
      }
    const heights = elevationSums(bands, j / height, (j + 1) / height, parts);
    for (let c = 0; c < 3; ++c)
      for (let l = 0; l < bands; ++l)
        for (let m = -l; m <= l; ++m) {
          const wave = row[c * (2 * bands - 1) + (m >= 0 ? m : bands - 1 - m)];
          // Azimuths run the other way around +Y than around the basis' own pole.
          sums[c][l * (l + 1) + m] += (m < 0 ? -1 : 1) * heights[l * (l + 1) + Math.abs(m)] * wave;
        }
  }
  // Columns: where x, y and z of the sums lie; x along +X, y along -Z, z along +Y.
  const rotation = new HarmonicRotation(bands, [1, 0, 0, 0, 0, 1, 0, -1, 0]);
  return sums.map((values) => rotation.apply(values)) as Coefficients;
}

/** Returns integrals over each column of cos(m a), m = 0 to bands - 1, and sin(m a), m = 1 to bands - 1. */
function azimuthWaves(width: number, bands: number, parts: number): Float64Array {
  const waves = new Float64Array(width * (2 * bands - 1));
  const step = (2 * Math.PI) / (width * parts);
  for (let i = 0; i < width; ++i)
    for (let part = 0; part < parts; ++part) {
      const azimuth = step * (i * parts + part + 0.5) - Math.PI;
      for (let m = 0; m < bands; ++m) {
        waves[i * (2 * bands - 1) + m] += step * Math.cos(m * azimuth);
        if (m > 0) waves[i * (2 * bands - 1) + bands - 1 + m] += step * Math.sin(m * azimuth);
      }
    }
  return waves;
}

/** Integrates the elevation's factor of each harmonic of m >= 0 over v = `low` to `high`. */
function elevationSums(bands: number, low: number, high: number, parts: number): Float64Array {
  const sums = new Float64Array(bands * bands);
  for (let part = 0; part < parts; ++part) {
    const lower = Math.PI * (low + ((high - low) * part) / parts - 0.5);
    const upper = Math.PI * (low + ((high - low) * (part + 1)) / parts - 0.5);
    const middle = 0.5 * (lower + upper);
    const weight = Math.sin(upper) - Math.sin(lower);
    const values = evaluateBasis(bands, Math.cos(middle), 0, Math.sin(middle));
    for (let i = 0; i < sums.length; ++i) sums[i] += weight * values[i];
  }
  return sums;
}
