// SPDX-License-Identifier: MIT
// Windows against ringing: docs/format.md, "Light".
import { clampedCosine, evaluateBasis } from './harmonics';

export type LightWindow = 'none' | 'hann' | 'lanczos' | 'dering';
export const lightWindows: LightWindow[] = ['hann', 'lanczos', 'dering', 'none'];

function laplacian(bands: number, strength: number): number[] {
  return Array.from({ length: bands }, (_, l) => 1 / (1 + strength * l * l * (l + 1) ** 2));
}

/** Finds the least strength at which nothing rings, to a thousandth of it. */
function leastStrength(rings: (strength: number) => boolean, weakest = 0): number {
  if (!rings(weakest)) return weakest;
  let weak = weakest;
  let strong = Math.max(1e-3, weakest);
  while (rings(strong)) [weak, strong] = [strong, 2 * strong];
  while (strong - weak > 1e-3 * strong) {
    const middle = 0.5 * (weak + strong);
    if (rings(middle)) weak = middle;
    else strong = middle;
  }
  return strong;
}

function plainWindow(window: LightWindow, bands: number): number[] | null {
  if (window === 'dering') return null;
  return Array.from({ length: bands }, (_, l) => {
    const x = (Math.PI * l) / bands;
    if (window === 'hann') return (1 + Math.cos(x)) / 2;
    if (window === 'lanczos') return l === 0 ? 1 : Math.sin(x) / x;
    return 1;
  });
}

/** Returns the sum over l of terms_l P_l(x). */
function legendreSum(terms: number[], x: number): number {
  let sum = 0;
  let before = 0;
  let value = 1;
  for (let l = 0; l < terms.length; ++l) {
    sum += terms[l] * value;
    [before, value] = [value, ((2 * l + 1) * x * value - l * before) / (l + 1)];
  }
  return sum;
}

/** Finds the least value of a function around an axis: the least of many places on a meridian, then between its neighbours. */
function leastOnMeridian(terms: number[]): number {
  const places = 32 * terms.length + 32;
  const step = Math.PI / places;
  const value = (angle: number) => legendreSum(terms, Math.cos(angle));
  let best = 0;
  for (let k = 1; k <= places; ++k) if (value(step * k) < value(step * best)) best = k;
  let [low, high] = [step * (best - 1), step * (best + 1)];
  for (let round = 0; round < 40; ++round) {
    const third = (high - low) / 3;
    if (value(low + third) < value(high - third)) high -= third;
    else low += third;
  }
  return Math.min(value(step * best), value(0.5 * (low + high)));
}

/** Returns the factors of the bands of a light z_l B_lm(d) around an axis, scaled so that the facing white surface has radiance 1. */
export function axialWeights(zonal: number[], window: LightWindow): number[] {
  const bands = zonal.length;
  let weights = plainWindow(window, bands);
  if (!weights) {
    const least = (strength: number) => {
      const damped = laplacian(bands, strength);
      return leastOnMeridian(zonal.map((z, l) => z * damped[l] * (2 * l + 1)));
    };
    weights = laplacian(bands, leastStrength((strength) => least(strength) < -1e-6 * zonal[0]));
  }
  const cosine = clampedCosine(bands);
  const facing = weights.reduce((sum, w, l) => sum + (w * zonal[l] * cosine[l] * (2 * l + 1)) / (4 * Math.PI * Math.PI), 0);
  return weights.map((w) => w / facing);
}

/** Directions spread evenly over the sphere, a dozen for each coefficient. */
function spreadDirections(bands: number): Float64Array[] {
  const count = 64 + 12 * bands * bands;
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: count }, (_, k) => {
    const y = 1 - (2 * (k + 0.5)) / count;
    const r = Math.sqrt(1 - y * y);
    return new Float64Array([r * Math.cos(golden * k), y, r * Math.sin(golden * k)]);
  });
}

/** Returns the weights of `window` for a light of any shape, of which `channels` are the coefficients. */
export function generalWeights(channels: ArrayLike<number>[], bands: number, window: LightWindow): number[] {
  const plain = plainWindow(window, bands);
  if (plain) return plain;
  const directions = spreadDirections(bands);
  const spacing = Math.sqrt((4 * Math.PI) / directions.length);
  let needed = 0;
  for (const coefficients of channels) {
    if (!(coefficients[0] > 0)) continue;
    const bandsAt = (d: ArrayLike<number>) => {
      const values = evaluateBasis(bands, d[0], d[1], d[2]);
      const sums = new Float64Array(bands);
      for (let l = 0, i = 0; l < bands; ++l) for (; i < (l + 1) ** 2; ++i) sums[l] += coefficients[i] * values[i];
      return sums;
    };
    const tables = directions.map(bandsAt);
    const largest = Array.from(coefficients).reduce((most, c) => Math.max(most, Math.abs(c)), 0);
    const weighted = (sums: ArrayLike<number>, w: number[]) => w.reduce((sum, factor, l) => sum + factor * sums[l], 0);
    const minimum = (w: number[]) => {
      const order = tables.map((table, k) => ({ value: weighted(table, w), k })).sort((a, b) => a.value - b.value);
      return Math.min(...order.slice(0, 4).map(({ value, k }) => downhill(directions[k], value, spacing, (d) => weighted(bandsAt(d), w))));
    };
    needed = leastStrength((strength) => minimum(laplacian(bands, strength)) < -1e-6 * largest, needed);
  }
  return laplacian(bands, needed);
}

/** Descends to a local minimum by pattern search in the tangent plane. */
function downhill(start: ArrayLike<number>, least: number, spacing: number, value: (d: number[]) => number): number {
  let at = Array.from(start);
  for (let step = 0.5 * spacing; step > 1e-4 * spacing; step *= 0.5) {
    const helper = Math.abs(at[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
    const u = unit(cross(at, helper));
    const v = cross(at, u);
    for (const move of [u, u.map((c) => -c), v, v.map((c) => -c)]) {
      const trial = unit(at.map((c, k) => c + step * move[k]));
      const there = value(trial);
      if (there < least) [least, at] = [there, trial];
    }
  }
  return least;
}

function cross(a: number[], b: number[]): number[] {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(a: number[]): number[] {
  const length = Math.hypot(...a);
  return a.map((c) => c / length);
}
